// Adhesion of hard grains (Derjaguin, Muller and Toporov 1975, J. Colloid Interface Sci. 53, 314-326; Maugis 1992,
// ibid. 150, 243-269): a pull beside the contact that has reach.
//
//   touching: F_a = 2 pi w R*,   gap 0 to 9 z0: F_a = 2 pi w R* ((z0/(z0 + gap))^2 - c)/(1 - c),   c = 1/100
//
// With z0, the range, the pull falls as that of van der Waals' forces between spheres, shifted and stretched so that it
// is continuous at contact and zero at the reach 9 z0. w = 2 gamma. Friction goes with the force of the contact, which
// is F + F_a. Tabor's number (R* w^2/(E*^2 z0^3))^(1/3) says which law: DMT below 0.1, JKR (jkr.hpp) above 5.
#pragma once

#include "rvelab/interaction/law.hpp"

namespace rvelab {

struct VanDerWaals {
  double surface_energy = 0;  ///< gamma, J/m^2, > 0
  double range = 0;           ///< z0, m, > 0
};
inline constexpr SettingsField<VanDerWaals> van_der_waals_fields[] = {
    {"surface_energy_J_m2", &VanDerWaals::surface_energy, "J/m^2", number_from_zero,
     "of the grains, half the work of adhesion", true},
    {"range_m", &VanDerWaals::range, "m", number_from_zero,
     "over which the pull falls to a quarter; it ends at 9 times it", true},
};

struct DmtAdhesion : NormalForceAlone<DmtAdhesion> {
  static constexpr const char* name = "dmt_pairs";
  static constexpr Family family = Family::adhesion;
  using Settings = VanDerWaals;
  static constexpr const char* settings_name = "dmt";
  static constexpr const auto& settings_fields = van_der_waals_fields;
  static constexpr RemovalKey removal{"removed", "the grains stick no longer"};
  static constexpr InteractionField fields[] = {
      {"pull_off_N", "N", positive_number},  // 2 pi w R*
      {"range_m", "m", positive_number},     // z0
  };
  enum Column { pull_off, range };

  static constexpr double pi = 3.14159265358979323846;
  static constexpr double reach_over_range = 9, far = 1 + reach_over_range, cut = 1 / (far * far);

  static const char* misfit(const VanDerWaals& surface, const SpecimenKind&) {
    return surface.surface_energy > 0 && surface.range > 0 ? nullptr : "surface_energy_J_m2 and range_m above 0";
  }
  static double reach(const VanDerWaals& surface) { return reach_over_range * surface.range; }
  static void prepare(const VanDerWaals& surface, const GrainPair& pair, double* columns) {
    columns[pull_off] =
        4 * pi * surface.surface_energy * pair.radius_i * pair.radius_j / (pair.radius_i + pair.radius_j);
    columns[range] = surface.range;
  }

  template <class Columns>
  static bool acts(const Columns& column, double gap) {
    return gap < reach_over_range * column(range);
  }
  /// It follows from where the grains lie.
  template <class Columns>
  static bool kept(const Columns&) {
    return false;
  }
  template <class Columns>
  static InteractionStiffness stiffness(const Columns& column, double gap, double /*thickness*/) {
    if (!acts(column, gap) || gap < 0) return {};
    const double share = column(range) / (column(range) + gap);
    return {-2 * column(pull_off) / column(range) * (share * share * share) / (1 - cut), 0, 0, 0};
  }
  static constexpr bool has_energy = true;
  /// Over that of grains apart, J.
  template <class Columns>
  static double energy(const Columns& column, double gap, double /*thickness*/) {
    if (!acts(column, gap)) return 0;
    const double s = gap > 0 ? gap : 0, far_off = 1 + s / column(range);
    const double outside =
        column(pull_off) * column(range) * ((1 / far_off - 1 / far) - cut * (far - far_off)) / (1 - cut);
    return column(pull_off) * (gap - s) - outside;
  }

  template <bool Advance, bool plane, class V>
  static inline __attribute__((always_inline)) V normal_force(const InteractionArrays& p, long at, V length) {
    const V zero = V{}, one = zero + 1.0;
    const V z = load_as<V>(p.column[range] + at),
            gap = length - (load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at));
    const V s = (gap > zero) ? gap : zero, share = z / ((z > zero) ? z + s : one);
    const V pull = (share * share - cut) * (1 / (1 - cut));
    return (pull > zero) ? zero - load_as<V>(p.column[pull_off] + at) * pull : zero;
  }
};

}  // namespace rvelab
