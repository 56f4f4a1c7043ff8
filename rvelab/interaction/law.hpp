// What the law of an interaction other than a contact declares and is handed. An interaction is a pair of grains on
// which forces act whether the grains touch or not, such as a bond; it is made in a test or forms by itself, is kept
// with numbers of its own, and ends by its law. A law is one file, like parallel_bond.hpp, and a word in laws.hpp:
// specimens, files, snapshots, trials, the turning of cells and the step kernels follow from what it declares.
//
// Interactions that form by themselves need what they form from, such as water. Their law declares `Settings`: numbers
// of the specimen, none or one row, with `settings_name` and `settings_fields`; a stage of that name gives them, and
// takes them away by the key `removal`; where settings may follow from what they make (saturation), that is `target`,
// and `settings_for` finds them. `misfit` is what is allowed where settings cannot be, else null; `reach` (m) is the
// gap up to which one may form, 0 where grains must touch; `prepare` makes of settings the columns of a pair that is
// near, which are zero when it is new.
//
// This module knows two grains at a time. No standard library: step kernels include the laws.
#pragma once

#include <cstdint>

#include "rvelab/contact/parameter.hpp"
#include "rvelab/lanes/vectors.hpp"

namespace rvelab {

/// Among what records count and add up the interactions of a law.
enum class Family { bonds, water, adhesion };

constexpr Interval any_number{-no_bound, no_bound, true, true};

/// How a number that an interaction keeps turns with its grains.
enum class Turning {
  scalar,
  tangent,  ///< a vector on j across the normal; in the plane its component along t = (-n_y, n_x), the first of three
  moment    ///< a moment on j across the normal; in the plane about z, the third of three
};

/// A number, or three, that each interaction keeps; `name` as files write it, ends in its unit.
struct InteractionField {
  const char *name, *unit;
  Interval allowed;
  Turning turning = Turning::scalar;
  bool whole = false;  ///< stands for a state, 0, 1, ...
};

/// Doubles that the fields of a law take.
template <class Law>
constexpr int interaction_columns() {
  int columns = 0;
  for (const InteractionField& field : Law::fields) columns += field.turning == Turning::scalar ? 1 : 3;
  return columns;
}
constexpr int most_interaction_columns = 24;

/// One of the numbers that interactions of a law form from, as a stage reads it and files write it.
template <class Settings>
struct SettingsField {
  const char* name;
  double Settings::*value;
  const char* unit;
  Interval allowed;
  const char* meaning;
  bool none_at_zero = false;  ///< 0: not given
};
struct RemovalKey {
  const char *name, *meaning;
};
/// What a law's settings may be given by instead: one number of the specimen, from which they follow.
struct TargetKey {
  const char *name, *unit;
  Interval allowed;
  const char* meaning;
};
template <class Law>
concept FormsByItself = requires {
  typename Law::Settings;
};

/// Two grains that are near.
struct GrainPair {
  double radius_i = 0, radius_j = 0;  ///< m
  double thickness = 0;               ///< m, in the plane, else 0
  double gap = 0;                     ///< m, negative where they overlap
  double contact_stiffness = 0;       ///< of their contact (ContactConstants::kn): linear N/m, Hertz N/m^1.5
};
template <class Law>
concept HasTarget = requires {
  Law::target;
};
/// What a law asks of a specimen.
struct SpecimenKind {
  int dimension = 3;
  bool hertz = false;  ///< normal forces of contacts go with overlap^(3/2)
};

/// Interactions of one kind, padded to a multiple of eight with some between padding grains.
struct InteractionArrays {
  const std::int32_t *row_i = nullptr, *row_j = nullptr;  ///< as those of PairArrays (solver/kernels/configuration.hpp)
  const double* image[3] = {};
  const double *radius_i = nullptr, *radius_j = nullptr;  ///< m
  double* column[most_interaction_columns] = {};          ///< the fields of the law, one after the other
  double thickness = 0;                                   ///< m, in the plane
  /// Force rows behind those of the pairs: in the plane {fx, fy, T_j, T_i}, in space {fx, fy, fz, -, T_j, -}.
  double* force = nullptr;
  /// Resultants of the grains, as long as grain rows and where these are; interactions add to them (GrainArrays).
  double* resultants = nullptr;
};

namespace {

/// Motion of W pairs in the plane over a sub-step.
template <class V>
struct PlaneMotion {
  V length;     ///< of the branch, m
  V slip = {};  ///< of j against i along t half way along the branch, m
  V turn = {};  ///< of j less that of i, rad
};
/// On j, N and N m; the normal force is positive in compression.
template <class V>
struct PlaneForces {
  V normal, tangential, moment;
};

/// Motion of W pairs in space over a sub-step.
template <class V>
struct SpaceTurn {
  Triple<V> n;          ///< from i to j
  V length;             ///< of the branch, m
  Triple<V> slip = {};  ///< of j against i across n half way along the branch, m
  Triple<V> turn = {};  ///< of j less that of i, rad
};
template <class V>
struct SpaceForces {
  V normal;
  Triple<V> tangential, moment;
};

}  // namespace

/// What bonds have in common: broken ones act no more and are kept, since where they broke is a result.
template <class Law>
struct BondLaw {
  static constexpr Family family = Family::bonds;
  template <class Columns>
  static bool kept(const Columns&) {
    return true;
  }
  template <class Columns>
  static bool acts(const Columns& column, double /*gap*/) {
    return column(Law::broken) == 0;
  }
};

/// Laws that act along the normal alone, by their normal_force<Advance, plane, V>(arrays, at, length of the branch).
template <class Law>
struct NormalForceAlone {
  template <bool Advance, class V>
  static inline __attribute__((always_inline)) PlaneForces<V> in_plane(const InteractionArrays& p, long at,
                                                                       const PlaneMotion<V>& m) {
    return {Law::template normal_force<Advance, true, V>(p, at, m.length), V{}, V{}};
  }
  template <bool Advance, class V>
  static inline __attribute__((always_inline)) SpaceForces<V> in_space(const InteractionArrays& p, long at,
                                                                       const SpaceTurn<V>& m, const Triple<V>*) {
    const V zero = V{};
    return {Law::template normal_force<Advance, false, V>(p, at, m.length), {zero, zero, zero}, {zero, zero, zero}};
  }
};

/// Elastic stiffness of an interaction now. N/m; N m: against bending and, in space, against twisting.
struct InteractionStiffness {
  double normal = 0, tangential = 0, bending = 0, twisting = 0;
};

}  // namespace rvelab
