// Contact parameters as a user states them: materials, law, slip convention, rolling, damping; and what a pair of
// grains makes of them. Which law does what stands in the law's own file; here are names, units, ranges and mixing.
//
// This module knows two grains at a time: no list, no cell, no step loop.
#pragma once

#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include "rvelab/contact/interval_words.hpp"
#include "rvelab/contact/kinds.hpp"
#include "rvelab/contact/laws.hpp"
#include "rvelab/error.hpp"

namespace rvelab {

/// What parameters may be, for keys, files and checks alike. Those of a law stand in its file.
namespace ranges {
/// kg/m^3: masses and moments of inertia, and 1 over them, stay numbers; a grain of 1e30 counts as fixed.
inline constexpr Interval density{1e-50, 1e50};
inline constexpr Interval friction{0, 1e6};  ///< 1e6: no slip
inline constexpr Interval local_damping{0, 1, false, true}, local_damping_quasi_static{0, 1, true, true};
inline constexpr Interval restitution{0, 1, true, false};  ///< dashpots divide by its logarithm
}  // namespace ranges

/// One grain material. Of the laws' constants only those that the specimen's law uses are read; the others keep zero.
struct Material : LawConstants {
  std::string name = "grain";
  double density = 2650;         ///< kg/m^3
  double friction = 0;           ///< Coulomb coefficient mu = tan(phi_mu), 0 to 1e6 (1e6: no slip)
  double rolling_stiffness = 0;  ///< beta of k_r = kt ri rj beta, >= 0
  double rolling_friction = 0;   ///< eta of the cap min(eta_i ri, eta_j rj) fn, >= 0
};

/// What holds for every contact of a specimen.
struct ContactModel {
  Law law = Law::linear;
  Slip slip = Slip::consistent;
  bool rolling = false;        ///< rolling moment between grains (its parameters stand in the materials)
  bool unload_rescale = true;  ///< hertz_mindlin, hertz_rough, cones: f_t falls with k_t as delta falls
  HertzRadius hertz_radius = HertzRadius::equivalent;  ///< hertz_mindlin, ellipses (hertz_curvature.hpp)
};

/// Damping, apart from the law. All of it acts on fluctuation velocities v' and spins w'.
struct Damping {
  double local = 0;                 ///< Cundall's coefficient at a rate, 0 to < 1
  double local_quasi_static = 0.3;  ///< the same in quasi-static loading, > 0 to < 1
  LocalDampingForm local_form = LocalDampingForm::vector;
  Dashpot dashpot = Dashpot::none;
  double normal_coefficient = 0;  ///< coefficient: N s/m; viscoelastic: 1/(m s) (force eta sqrt(r* delta) m* v)
  double restitution = 1;         ///< restitution: coefficient of restitution of two grains, 0 < e <= 1; tsuji: that of
                                  ///< LAMMPS' fit, which is met at 1 only
  double tangential_ratio = 0;    ///< tangential over normal dashpot coefficient, >= 0
  bool no_tension = false;        ///< cuts the normal force at zero, so that a dashpot never attracts
  double global_viscous = 0;      ///< N s/m, force -c v' on each grain, at a rate only
};

/// A number of a material that a law reads, and where it stands.
struct LawParameter {
  Law law;
  Parameter parameter;
  double Material::*value;
};

/// Those of all laws, in the order of the laws.
const std::vector<LawParameter>& law_parameters();

/// Parameters of one pair of grains, computed once when the pair is listed.
struct PairParameters : ContactConstants {
  double friction = 0;    ///< the smaller of the two
  double kr = 0;          ///< constant of k_r = kt ri rj beta: N m; hertz_mindlin N m/m^0.5, cones N m/m
  double moment_cap = 0;  ///< min(eta_i ri, eta_j rj), m
  double cn = 0;          ///< dashpot: c_n = cn delta^dashpot_power
};

/// Power of the overlap in the dashpot coefficient: 0 (coefficient, linear), 1/2 (viscoelastic; restitution with
/// cones), 1/4 (restitution and tsuji with a Hertz law; of rough surfaces where they are pressed far).
double dashpot_power(Law law, Dashpot dashpot);

/// Mixes two materials for grains of radii ri, rj (m) and masses mi, mj (kg). `section`: cross-section of the smaller
/// grain, m^2 (grain_section).
PairParameters mix(const ContactModel& model, const Damping& damping, const Material& a, double ri, double mi,
                   const Material& b, double rj, double mj, double section);

/// Checks every parameter that the model uses. Throws InputError naming key, value and range, one line each.
void check_parameters(const ContactModel& model, const Damping& damping, const std::vector<Material>& materials);

template <class>
struct NamesOf;
template <class... Each>
struct NamesOf<TypeList<Each...>> {
  static constexpr const char* names[] = {Each::name...};
};
/// The key of a choice, and the names of its values in their order.
template <class Choice>
struct Named;
template <>
struct Named<Law> : NamesOf<Laws> {
  static constexpr const char* key = "contact.law";
};
template <>
struct Named<Slip> {
  static constexpr const char *key = "contact.slip", *names[] = {"consistent", "full_radius", "full_radius_ratcheting"};
};
template <>
struct Named<HertzRadius> {
  static constexpr const char *key = "contact.hertz_radius", *names[] = {"equivalent", "curvature"};
};
template <>
struct Named<Dashpot> {
  static constexpr const char *key = "damping.dashpot",
                              *names[] = {"none", "coefficient", "restitution", "viscoelastic", "tsuji"};
};
template <>
struct Named<LocalDampingForm> {
  static constexpr const char *key = "damping.local_form", *names[] = {"vector", "component"};
};
template <class Choice>
constexpr auto name(Choice choice) -> decltype(Named<Choice>::names[0] + 0) {
  return Named<Choice>::names[std::size_t(choice)];
}
/// "linear, linear_stiffness, ...": the names of the values for which this holds.
template <class Choice, class Holds>
std::string names_where(const Holds& holds) {
  std::string names;
  for (int k = 0; k < int(std::size(Named<Choice>::names)); ++k)
    if (holds(Choice(k))) names += (names.empty() ? "" : ", ") + std::string(name(Choice(k)));
  return names;
}
template <class Choice>
std::string names_of() {
  return names_where<Choice>([](Choice) { return true; });
}
inline std::string law_names() { return names_of<Law>(); }
/// The value of a name; throws InputError listing the names.
template <class Choice>
Choice choice_from(const std::string& text) {
  for (int k = 0; k < int(std::size(Named<Choice>::names)); ++k)
    if (text == name(Choice(k))) return Choice(k);
  throw InputError(std::string(Named<Choice>::key) + " = \"" + text +
                   "\" is not known; allowed: " + names_of<Choice>() + "; choose one of these");
}

}  // namespace rvelab
