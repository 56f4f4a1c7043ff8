// Contact bonds: grains glued at a point, which carries forces and no moment (Potyondy and Cundall 2004; Itasca's
// contact bond). Beside the contact of the two grains:
//
//   f_n = min(kn (g0 - g), 0),   f_s <- f_s - ks du_s
//   -f_n > tensile strength: broken in tension;   |f_s| > shear strength + tan(phi) max(kn (g0 - g), 0): in shear
//
// g is the gap, g0 that when the bond was made (negative where the grains overlapped).
// Pressure is the contact's to bear. Its friction slips beside the bond, so that a pressed pair resists shear by the
// bond and by its friction; in PFC the contact does not slip while the bond holds. du_s: beam.hpp.
#pragma once

#include "rvelab/interaction/beam.hpp"

namespace rvelab {

struct ContactBond : BondLaw<ContactBond> {
  static constexpr const char* name = "contact_bonds";
  static constexpr InteractionField fields[] = {
      {"gap_m", "m", any_number},                         // g0
      {"normal_stiffness_N_m", "N/m", number_from_zero},  // kn
      {"shear_stiffness_N_m", "N/m", number_from_zero},   // ks
      {"tensile_strength_N", "N", number_from_zero},
      {"shear_strength_N", "N", number_from_zero},
      {"friction", "1", number_from_zero},             // tan(phi)
      {"broken", "1", {0, 2}, Turning::scalar, true},  // 0 no, 1 in tension, 2 in shear
      {"released_energy_J", "J", number_from_zero},    // as it broke
      {"shear_force_N", "N", {-no_bound, no_bound}, Turning::tangent},
  };
  enum Column {
    first_gap,
    normal_stiffness,
    shear_stiffness,
    tensile_strength,
    shear_strength,
    friction,
    broken,
    released,
    shear_force
  };

  template <class Columns>
  static InteractionStiffness stiffness(const Columns& column, double gap, double /*thickness*/) {
    if (column(broken) != 0) return {};
    return {gap > column(first_gap) ? column(normal_stiffness) : 0, column(shear_stiffness), 0, 0};
  }
  static constexpr bool has_energy = false;

  /// Normal force of W bonds, and which are whole after this step.
  template <bool Advance, class V>
  static inline __attribute__((always_inline)) V normal_force(const InteractionArrays& p, long at, V length,
                                                              V shear_squared, V& was) {
    const V zero = V{}, one = zero + 1.0, two = zero + 2.0;
    const V kn = load_as<V>(p.column[normal_stiffness] + at), ks = load_as<V>(p.column[shear_stiffness] + at);
    const V gap = length - (load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at));
    const V spring = kn * (load_as<V>(p.column[first_gap] + at) - gap);
    const V pull = (spring < zero) ? spring : zero, press = spring - pull;
    was = load_as<V>(p.column[broken] + at);
    if constexpr (Advance) {
      const V limit = load_as<V>(p.column[shear_strength] + at) + load_as<V>(p.column[friction] + at) * press;
      const auto in_tension = zero - pull > load_as<V>(p.column[tensile_strength] + at);
      const V how = in_tension ? one : ((shear_squared > limit * limit) ? two : zero);
      book_release(p, released, at, was, how,
                   [&](auto energy) { return energy(pull * pull, kn) + energy(shear_squared, ks); });
      was = (was == 0.0) ? how : was;
      store_as(p.column[broken] + at, was);
    }
    return (was == 0.0) ? pull : zero;
  }

  template <bool Advance, class V>
  static inline __attribute__((always_inline)) PlaneForces<V> in_plane(const InteractionArrays& p, long at,
                                                                       const PlaneMotion<V>& m) {
    const V zero = V{};
    V shear = load_as<V>(p.column[shear_force] + at), was;
    if constexpr (Advance) shear = shear - load_as<V>(p.column[shear_stiffness] + at) * m.slip;
    PlaneForces<V> f;
    f.normal = normal_force<Advance, V>(p, at, m.length, shear * shear, was);
    f.tangential = (was == 0.0) ? shear : zero;
    f.moment = zero;
    if constexpr (Advance) store_as(p.column[shear_force] + at, f.tangential);
    return f;
  }
  template <bool Advance, class V>
  static inline __attribute__((always_inline)) SpaceForces<V> in_space(const InteractionArrays& p, long at,
                                                                       const SpaceTurn<V>& m, const Triple<V>* turned) {
    const V zero = V{};
    const Triple<V> none = {zero, zero, zero};
    Triple<V> shear = turned[0];
    V was;
    if constexpr (Advance) shear = plus(shear, -load_as<V>(p.column[shear_stiffness] + at), m.slip);
    SpaceForces<V> f;
    f.normal = normal_force<Advance, V>(p, at, m.length, dot(shear, shear), was);
    f.tangential = chosen(was == 0.0, shear, none);
    f.moment = none;
    if constexpr (Advance) store_vec(p.column + shear_force, at, f.tangential);
    return f;
  }
};

}  // namespace rvelab
