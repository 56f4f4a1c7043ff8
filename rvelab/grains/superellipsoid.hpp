// Superellipsoids (|x/a|^e + |y/b|^e)^(n/e) + |z/c|^n <= 1 in space, ellipsoids where both exponents are 2
// (description.hpp; formulas of one body in superellipsoid/body.hpp).
//
// Each is a body of its own (Specimen::bodies), which keeps its orientation, x y z of the shape to the cell frame, and
// its motion. Its row among the grains is {x, y, z, rho, u, v, w, 0, wx, wy, wz, 0, q0, q1, q2, q3, a, b, c, P, N, R,
// S, l}: q the orientation, rho the radius of a ball that rolls inside, P = 1 - 1/(e - 1), N = 1 - 1/(n - 1), R = 1/2 -
// 1/e, S = 1/2 - 1/n, l = Extent::turning. So a row of zeros, as those that pad the lanes are, is a sphere of no size.
#pragma once

#include "rvelab/grains/description.hpp"

namespace rvelab {

struct SuperellipsoidGrain {
  static constexpr const char* name = "superellipsoid";
  static constexpr int dimension = 3;
  static constexpr bool round = false, rigid = true, pairs_hold_radii = false, fills_rows = false,
                        has_hertz_curvature = true;

  static constexpr int row_length = 24, released_mass = 7, released_inverse_inertia = 11;

  template <template <class> class Of>
  struct Columns {
    Of<double> half_x{}, half_y{}, half_z{};  ///< m; empty with other shapes
    Of<double> exponent_xy{}, exponent_z{};   ///< e and n
  };
  using Own = Columns<One>;
  template <template <class> class Of>
  static constexpr OwnColumn<Columns<Of>, Of<double>> columns[] = {
      {"half_x_m", "half_x", &Columns<Of>::half_x},
      {"half_y_m", "half_y", &Columns<Of>::half_y},
      {"half_z_m", "half_z", &Columns<Of>::half_z},
      {"exponent_xy", "exponent_xy", &Columns<Of>::exponent_xy, "1"},
      {"exponent_z", "exponent_z", &Columns<Of>::exponent_z, "1"}};

  static constexpr const char *allowed_lengths =
                                  "half axes > 0, the longest at most 10 times the shortest, exponents 2 to 20",
                              *allowed_in_tables = "half axes > 0, at most 10 times each other, exponents 2 to 20";
  static bool allowed(const Own& own);
  static constexpr const char* radius_in_words = "that of the sphere of its volume";
  static double radius(const Own& own);
  /// About the axis of its largest moment, kg m^2.
  static double inertia(double mass, double radius, const Own& own);
  /// `turning`: a - c of ellipsoids, |x n| being at most that; else sqrt(R^2 - r^2), since |x x n|^2 = |x|^2 - h^2.
  static Extent extent(const Own& own);
  /// Bounds on its radii of curvature, m, no larger than those that count (superellipsoid/support.hpp).
  struct Radii {
    double least, largest;
  };
  static Radii radii_of_curvature(const Own& own);
};

inline constexpr double largest_exponent = 20;

}  // namespace rvelab
