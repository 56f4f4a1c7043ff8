// Grains in a soft coat, a law for the check that the next law is one file and a word (tools/validate new_law): it
// repels from the gap s on, resists slip of the coats by a spring, and adds up how far they slipped.
//
//   gap < s:  f_n = k (s - gap),   f_s <- f_s - k/2 du_s,   path <- path + |du_s|;   beyond: all forgotten
#pragma once

#include "rvelab/interaction/law.hpp"

namespace rvelab {

struct Coat {
  double stiffness = 0;  ///< k, N/m
  double reach = 0;      ///< s, m
};
inline constexpr SettingsField<Coat> coat_fields[] = {
    {"stiffness_N_m", &Coat::stiffness, "N/m", number_from_zero, "of two coats in series"},
    {"reach_m", &Coat::reach, "m", number_from_zero, "gap from which coats touch"},
};

struct SoftCoat {
  static constexpr const char* name = "coats_in_touch";
  static constexpr Family family = Family::adhesion;
  using Settings = Coat;
  static constexpr const char* settings_name = "coat";
  static constexpr const auto& settings_fields = coat_fields;
  static constexpr RemovalKey removal{"removed", "the coats are gone"};
  static constexpr InteractionField fields[] = {
      {"stiffness_N_m", "N/m", positive_number},
      {"reach_m", "m", positive_number},
      {"path_m", "m", number_from_zero},
      {"shear_force_N", "N", {-no_bound, no_bound}, Turning::tangent},
  };
  enum Column { stiffness_of_coats, limit, path, shear_force };

  static const char* misfit(const Coat& coat, const SpecimenKind&) {
    return coat.stiffness > 0 && coat.reach > 0 ? nullptr : "stiffness_N_m and reach_m above 0";
  }
  static double reach(const Coat& coat) { return coat.reach; }
  static void prepare(const Coat& coat, const GrainPair&, double* columns) {
    columns[stiffness_of_coats] = coat.stiffness;
    columns[limit] = coat.reach;
  }

  template <class Columns>
  static bool acts(const Columns& column, double gap) {
    return gap < column(limit);
  }
  template <class Columns>
  static bool kept(const Columns& column) {
    return column(path) > 0;
  }
  template <class Columns>
  static InteractionStiffness stiffness(const Columns& column, double /*gap*/, double /*thickness*/) {
    return {column(stiffness_of_coats), 0.5 * column(stiffness_of_coats), 0, 0};
  }
  static constexpr bool has_energy = false;

  /// Normal force, N; `apart`: whether the pair forgets.
  template <class V>
  static inline __attribute__((always_inline)) V normal_force(const InteractionArrays& p, long at, V length) {
    const V gap = length - (load_as<V>(p.radius_i + at) + load_as<V>(p.radius_j + at));
    const V pressed = load_as<V>(p.column[limit] + at) - gap;
    return (pressed > 0.0) ? load_as<V>(p.column[stiffness_of_coats] + at) * pressed : V{};
  }
  template <bool Advance, class V>
  static inline __attribute__((always_inline)) PlaneForces<V> in_plane(const InteractionArrays& p, long at,
                                                                       const PlaneMotion<V>& m) {
    const V zero = V{}, normal = normal_force<V>(p, at, m.length);
    V shear = load_as<V>(p.column[shear_force] + at);
    if constexpr (Advance) {
      const V so_far = load_as<V>(p.column[path] + at) + magnitude_of(m.slip);
      shear = shear - (0.5 * load_as<V>(p.column[stiffness_of_coats] + at)) * m.slip;
      shear = (normal > zero) ? shear : zero;
      store_as(p.column[shear_force] + at, shear);
      store_as(p.column[path] + at, (normal > zero) ? so_far : zero);
    }
    return {normal, shear, zero};
  }
  template <bool Advance, class V>
  static inline __attribute__((always_inline)) SpaceForces<V> in_space(const InteractionArrays& p, long at,
                                                                       const SpaceTurn<V>& m, const Triple<V>* turned) {
    const V zero = V{}, normal = normal_force<V>(p, at, m.length);
    const Triple<V> none = {zero, zero, zero};
    Triple<V> shear = turned[0];
    if constexpr (Advance) {
      const V so_far = load_as<V>(p.column[path] + at) + square_root(dot(m.slip, m.slip));
      shear = plus(shear, -0.5 * load_as<V>(p.column[stiffness_of_coats] + at), m.slip);
      shear = chosen(normal > zero, shear, none);
      store_vec(p.column + shear_force, at, shear);
      store_as(p.column[path] + at, (normal > zero) ? so_far : zero);
    }
    return {normal, shear, none};
  }
};

}  // namespace rvelab
