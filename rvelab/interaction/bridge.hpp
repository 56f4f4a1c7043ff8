// Bridges of liquid between two grains (capillary.hpp, planar_bridge.hpp: equations, sources): of spheres at given
// suction or at given volume, of discs at given suction. A bridge forms as the grains touch and lives to its rupture
// gap s_c.
//
//   spheres  f_n = -scale (1 - k s/h) sum c_m T_m(2 t - 1),   t = sqrt(1 - s/s_c),   h = sqrt(s^2 + b),   s = max(gap,
//   0) discs    f_n = -scale y,   y^2 = D_1^2 - x^2,   x = (L^2 + D_1^2 - D_2^2)/(2 L),   L = r_1 + r_2 + s
//
// f_n is positive in compression, so that a bridge pulls; k is 1 at given volume, where h = sqrt(gap^2 + 2 V/(pi R))
// takes the steep part, else 0. The coefficients of Chebyshev's polynomials belong to a pair, its radii and its water,
// and are made once, when the pair comes near; so are D_1, D_2, from the grains' centres to those of the arcs. Bridges
// give no moment.
#pragma once

#include "rvelab/interaction/water.hpp"

namespace rvelab {

struct CapillaryBridge : NormalForceAlone<CapillaryBridge> {
  static constexpr const char* name = "bridges";
  static constexpr Family family = Family::water;
  using Settings = Water;
  static constexpr const char* settings_name = "water";
  static constexpr const auto& settings_fields = water_fields;
  static constexpr RemovalKey removal{"flooded", "the pores fill: all bridges go"};
  static constexpr int terms = 16;
  static constexpr InteractionField fields[] = {
      {"present", "1", {0, 1}, Turning::scalar, true},  // 0: the grains are near, without a bridge
      {"rupture_gap_m", "m", number_from_zero},         // s_c
      {"scale_N", "N", number_from_zero},
      {"steepness", "1", {0, 1}},              // k
      {"square_m2", "m^2", number_from_zero},  // b
      {"pull_0", "1", any_number},
      {"pull_1", "1", any_number},
      {"pull_2", "1", any_number},
      {"pull_3", "1", any_number},
      {"pull_4", "1", any_number},
      {"pull_5", "1", any_number},
      {"pull_6", "1", any_number},
      {"pull_7", "1", any_number},
      {"pull_8", "1", any_number},
      {"pull_9", "1", any_number},
      {"pull_10", "1", any_number},
      {"pull_11", "1", any_number},
      {"pull_12", "1", any_number},
      {"pull_13", "1", any_number},
      {"pull_14", "1", any_number},
      {"pull_15", "1", any_number},
  };
  enum Column { present, rupture_gap, scale, steepness, square, pull };
  /// Of discs instead of coefficients: D_1^2, D_2^2, m^2, r_1 + r_2, m.
  enum PlaneColumn { first_square = pull, second_square, radii };

  /// Keeps the stiffness finite at rupture itself.
  static constexpr double least_t = 1e-6;

  /// Normal force, N, and its slope over the gap, N/m; of W bridges.
  template <class V>
  struct Pull {
    V force, slope;
  };
  template <class V, class Columns>
  static inline __attribute__((always_inline)) Pull<V> pull_at(const Columns& column, V gap) {
    const V zero = V{}, one = zero + 1.0;
    const V s = (gap > 0.0) ? gap : zero, limit = column(rupture_gap);
    const V safe = (limit > 0.0) ? limit : one, inside = one - s / safe;
    const V floor = zero + least_t * least_t;
    const V t = square_root((inside > floor) ? inside : floor), x = 2.0 * t - 1.0;
    V b1 = zero, b2 = zero, d1 = zero, d2 = zero;  // Clenshaw, and its derivative
    for (int k = terms - 1; k >= 1; --k) {
      const V d0 = 2.0 * (x * d1 + b1) - d2, b0 = 2.0 * (x * b1) - b2 + column(pull + k);
      d2 = d1, d1 = d0, b2 = b1, b1 = b0;
    }
    const V sum = (x * b1 - b2) + column(pull), over_t = 2.0 * ((x * d1 + b1) - d2);
    const V k = column(steepness), b = column(square);
    const V h = square_root(s * s + ((b > 0.0) ? b : one)), base = one - k * (s / h);
    const V slope =
        (column(scale) * (k * (b / (h * h * h)))) * sum + (column(scale) * base) * (over_t / (2.0 * (t * safe)));
    return {zero - (column(scale) * base) * sum, slope};
  }

  /// The same of discs.
  template <class V, class Columns>
  static inline __attribute__((always_inline)) Pull<V> plane_pull_at(const Columns& column, V gap) {
    const V zero = V{}, one = zero + 1.0, L = column(radii) + ((gap > 0.0) ? gap : zero);
    const V safe = (L > 0.0) ? L : one, first = column(first_square), second = column(second_square);
    const V x = (safe * safe + (first - second)) / (2.0 * safe), under = first - x * x;
    const V y = square_root((under > 0.0) ? under : zero);
    const V slope = x * (safe - x) / (safe * ((y > 0.0) ? y : one));
    return {zero - column(scale) * y, column(scale) * slope};
  }
  template <class Columns>
  static Pull<double> pull_of(const Columns& column, double gap, double thickness) {
    return thickness > 0 ? plane_pull_at<double>(column, gap) : pull_at<double>(column, gap);
  }

  static constexpr TargetKey target{"saturation",
                                    "1",
                                    {0, 0.3, true, false},
                                    "instead: volume of the bridges over that of the pores as the stage makes them; "
                                    "of equal volume_ratio between spheres, of one suction between discs"};
  /// Water of which the bridges of these pairs fill that part of the pores (m^3); nullptr, or why there is none.
  static const char* settings_for(double saturation, double pore_volume, const GrainPair* pairs, long count,
                                  Water& water);
  /// The part of the pores that they fill.
  static double target_of(const Water& water, double pore_volume, const GrainPair* pairs, long count);

  static const char* misfit(const Water& water, const SpecimenKind& specimen) {
    if ((water.suction > 0) == (water.volume_ratio > 0)) return "suction_Pa or volume_ratio above 0, one of them";
    return specimen.dimension == 2 && water.volume_ratio > 0
               ? "suction_Pa between discs, whose bridges it gives in closed form"
               : nullptr;
  }
  static double reach(const Water&) { return 0; }
  /// A pair that touches is wetted; a bridge that is there becomes one of this water.
  static void prepare(const Water& water, const GrainPair& pair, double* columns);

  template <class Columns>
  static bool acts(const Columns& column, double /*gap*/) {
    return column(present) != 0;
  }
  /// A specimen keeps those that are there; where grains are near is found anew.
  template <class Columns>
  static bool kept(const Columns& column) {
    return column(present) != 0;
  }
  template <class Columns>
  static InteractionStiffness stiffness(const Columns& column, double gap, double thickness) {
    if (!acts(column, gap) || gap < 0) return {};
    return {-pull_of(column, gap, thickness).slope, 0, 0, 0};
  }
  static constexpr bool has_energy = true;  ///< by itself: no springs
  /// Over that of the broken bridge, J: what pulling it to rupture takes, negative.
  template <class Columns>
  static double energy(const Columns& column, double gap, double thickness) {
    if (!acts(column, gap)) return 0;
    const double s = gap > 0 ? gap : 0, last = column(rupture_gap);
    // With gap = s_c (1 - t^2) the integrand is smooth: Simpson's rule over t.
    constexpr int parts = 64;
    const double from = __builtin_sqrt(last > s ? 1 - s / last : 0.0);
    double sum = 0;
    for (int k = 0; k <= parts; ++k) {
      const double t = from * k / parts, weight = k == 0 || k == parts ? 1 : (k % 2 == 1 ? 4 : 2);
      sum += weight * pull_of(column, last * (1 - t * t), thickness).force * 2 * t * last;
    }
    return sum * from / (3 * parts) + pull_of(column, 0.0, thickness).force * (s - gap);
  }

  template <bool Advance, bool plane, class V>
  static inline __attribute__((always_inline)) V normal_force(const InteractionArrays& p, long at, V length) {
    const V zero = V{}, one = zero + 1.0;
    const auto column = [&](int k) { return load_as<V>(p.column[k] + at); };
    const V gap = length - (load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at));
    V there = column(present);
    if constexpr (Advance) {
      const auto forms = (gap < zero) & (column(scale) > zero);
      const auto ruptures = gap > column(rupture_gap);
      there = forms ? one : (ruptures ? zero : there);
      store_as(p.column[present] + at, there);
    }
    V force;
    if constexpr (plane)
      force = plane_pull_at<V>(column, gap).force;
    else
      force = pull_at<V>(column, gap).force;
    return (there > zero) ? force : zero;
  }
};

}  // namespace rvelab
