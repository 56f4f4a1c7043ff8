// Ellipses of semi-axes a >= b (description.hpp).
#pragma once

#include <cmath>

#include "rvelab/grains/description.hpp"

namespace rvelab {

struct Ellipse {
  static constexpr const char* name = "ellipse";
  static constexpr int dimension = 2;
  static constexpr bool round = false, rigid = false, pairs_hold_radii = false, fills_rows = true,
                        has_hertz_curvature = true;

  static constexpr int row_length = 12, released_mass = 7, released_inverse_inertia = 11;

  template <template <class> class Of>
  struct Columns {
    Of<double> semi_major{}, semi_minor{};  ///< m; empty with other shapes
  };
  using Own = Columns<One>;
  template <template <class> class Of>
  static constexpr OwnColumn<Columns<Of>, Of<double>> columns[] = {{"semi_major_m", "a", &Columns<Of>::semi_major},
                                                                   {"semi_minor_m", "b", &Columns<Of>::semi_minor}};

  static constexpr const char *allowed_lengths = "semi_major >= semi_minor > 0, at most 10 times as long",
                              *allowed_in_tables = "0 < b <= a <= 10 b";
  static bool allowed(const Own& own) {
    const double a = own.semi_major, b = own.semi_minor;
    return b > 0 && a >= b && b >= least_aspect_ratio * (1 - 1e-12) * a && std::isfinite(a);
  }
  static constexpr const char* radius_in_words = "sqrt(semi_major semi_minor)";
  static double radius(const Own& own) { return std::sqrt(own.semi_major * own.semi_minor); }
  static Own of_aspect(double radius, double aspect_ratio) {
    const double root = std::sqrt(aspect_ratio);
    return {radius / root, radius * root};
  }

  static constexpr double inertia(double mass, double, const Own& own) {
    return 0.25 * mass * (own.semi_major * own.semi_major + own.semi_minor * own.semi_minor);
  }
  static constexpr Extent extent(const Own& own) {
    return {own.semi_major, own.semi_minor, own.semi_major - own.semi_minor};
  }
  /// b^2 and a^2 - b^2.
  static constexpr TurnValues turn_values(const Own& own) {
    const double a = own.semi_major, b = own.semi_minor;
    return {b * b, (a - b) * (a + b)};
  }
  /// Of support h and derivative h': the radius of curvature is a^2 b^2/h^3.
  static constexpr Bend bend(const Own& own, double support, double derivative) {
    const double axes = own.semi_major * own.semi_minor;
    return {axes * axes / (support * support * support) - support, -3 * derivative / support};
  }
};

}  // namespace rvelab
