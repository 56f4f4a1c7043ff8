#include "rvelab/keys/material_keys.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "rvelab/keys/key_builders.hpp"
#include "rvelab/solver/assembly/list_size.hpp"

namespace rvelab::keys {
namespace {

template <class Value>
std::string allowed(const Interval& range) {
  if constexpr (std::is_same_v<Value, bool>) return "true, false";
  if constexpr (std::is_same_v<Value, std::string>) return "any text, different for each material";
  if constexpr (std::is_same_v<Value, Law>) return law_names();
  if constexpr (std::is_same_v<Value, Slip>) return "consistent, full_radius, full_radius_ratcheting";
  if constexpr (std::is_same_v<Value, HertzRadius>) return "equivalent, curvature";
  if constexpr (std::is_same_v<Value, Dashpot>) return "none, coefficient, restitution, viscoelastic, tsuji";
  if constexpr (std::is_same_v<Value, LocalDampingForm>) return "vector, component";
  return in_words(range);
}

template <class Value>
const char* type_of() {
  if constexpr (std::is_same_v<Value, bool>) return "boolean";
  if constexpr (std::is_same_v<Value, double>) return "number";
  if constexpr (std::is_same_v<Value, long>) return "whole number";
  return std::is_same_v<Value, std::string> ? "text" : "choice";
}

/// The default is that of the struct: it is written nowhere twice.
template <class Owner, class Value>
KeyEntry entry(const char* table, const char* name, const char* unit, Value Owner::*member, const Interval& range,
               const char* meaning) {
  return {
      {table, name, unit, type_of<Value>(), as_toml(Owner{}.*member), allowed<Value>(range), meaning}, member, range};
}

/// What laws mean by a number that they read: "linear_given, hertz_given: kt".
std::string meaning_of(const char* key) {
  std::vector<std::pair<std::string, std::string>> meanings;  // a meaning, the laws that have it
  for (const LawParameter& each : law_parameters()) {
    if (each.parameter.key != std::string(key)) continue;
    const auto same = std::find_if(meanings.begin(), meanings.end(),
                                   [&](const auto& known) { return known.first == each.parameter.meaning; });
    if (same == meanings.end())
      meanings.emplace_back(each.parameter.meaning, name(each.law));
    else
      same->second += std::string(", ") + name(each.law);
  }
  std::string text;
  for (const auto& [meaning, laws] : meanings) text += (text.empty() ? "" : "; ") + laws + ": " + meaning;
  return text;
}

/// A key for each number that laws read.
std::vector<KeyEntry> law_constants() {
  std::vector<KeyEntry> entries;
  for (const LawParameter& each : law_parameters()) {
    const Parameter& p = each.parameter;
    const auto same = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.key.name == p.key; });
    if (same != entries.end()) continue;
    entries.push_back(entry("material", p.key, p.unit, each.value, p.allowed, meaning_of(p.key).c_str()));
  }
  return entries;
}

std::vector<KeyEntry> materials() {
  const char* t = "material";
  std::vector<KeyEntry> entries = {
      entry(t, "name", "-", &Material::name, any, "name of the material, for --set material.NAME.key"),
      entry(t, "density_kg_m3", "kg/m^3", &Material::density, positive, "density of the solid")};
  const std::vector<KeyEntry> constants = law_constants();
  entries.insert(entries.end(), constants.begin(), constants.end());
  const std::vector<KeyEntry> surface = {
      entry(t, "friction", "1", &Material::friction, {0, 1e6}, "Coulomb coefficient mu; 1e6: no slip"),
      {{t, "friction_angle_deg", "degree", "number", "", in_words(Interval{0, 90, false, true}),
        "in place of friction: mu is its tangent"},
       FrictionAngle{},
       {0, 90, false, true}},
      entry(t, "rolling_stiffness", "1", &Material::rolling_stiffness, not_negative, "beta of k_r = kt ri rj beta"),
      entry(t, "rolling_friction", "1", &Material::rolling_friction, not_negative,
            "eta of the moment cap min(eta_i ri, eta_j rj) fn"),
  };
  entries.insert(entries.end(), surface.begin(), surface.end());
  return entries;
}

std::vector<KeyEntry> contacts() {
  const char* t = "contact";
  return {
      entry(t, "law", "-", &ContactModel::law, any, "normal and tangential law of all contacts"),
      entry(t, "slip", "-", &ContactModel::slip, any,
            "where slip is measured and force acts; full_radius as LAMMPS, full_radius_ratcheting as YADE"),
      entry(t, "rolling", "-", &ContactModel::rolling, any, "rolling moment between grains"),
      entry(t, "unload_rescale", "-", &ContactModel::unload_rescale, any,
            "hertz_mindlin: the tangential force falls with sqrt(overlap) on unloading"),
      entry(t, "hertz_radius", "-", &ContactModel::hertz_radius, any,
            "hertz_mindlin, ellipses: radius of the law: sqrt(a b), or a^2 b^2/h^3 of the curvature at the contact, "
            "which conserves no energy"),
  };
}

std::vector<KeyEntry> damping() {
  const char* t = "damping";
  return {
      entry(t, "local", "1", &Damping::local, below_one, "Cundall's damping for dt > 0"),
      entry(t, "local_quasi_static", "1", &Damping::local_quasi_static, ratio, "Cundall's damping for dt = 0"),
      entry(t, "local_form", "-", &Damping::local_form, any, "component depends on the axes, as YADE"),
      entry(t, "dashpot", "-", &Damping::dashpot, any, "contact dashpot; acts at dt > 0 only"),
      entry(t, "normal_coefficient_N_s_m", "N s/m", &Damping::normal_coefficient, not_negative,
            "dashpot = coefficient: c_n"),
      entry(t, "viscoelastic_1_m_s", "1/(m s)", &Damping::normal_coefficient, not_negative,
            "dashpot = viscoelastic: eta of c_n = eta sqrt(r* overlap) m*"),
      entry(t, "restitution", "1", &Damping::restitution, {0, 1, true, false},
            "dashpot = restitution: coefficient of restitution of two grains, linear and Hertz; tsuji: e of LAMMPS' "
            "polynomial, Hertz only (grains rebound at 0.85 for 0.8, 0.44 for 0.3)"),
      entry(t, "tangential_ratio", "1", &Damping::tangential_ratio, not_negative,
            "tangential over normal dashpot coefficient"),
      entry(t, "no_tension", "-", &Damping::no_tension, any, "cuts the normal force at zero: a dashpot never attracts"),
      entry(t, "global_viscous_N_s_m", "N s/m", &Damping::global_viscous, not_negative,
            "force -c v' on each grain, dt > 0 only"),
  };
}

std::vector<KeyEntry> solver() {
  const char* t = "solver";
  return {
      entry(t, "skin", "1", &SolverOptions::skin, {0, largest_skin_ratio, true, false},
            "largest Verlet skin over the mean radius; fitted down while steps pass"),
      entry(t, "time_step_factor", "1", &SolverOptions::time_step_factor, ratio,
            "fraction of the critical step 2/omega_max"),
      entry(t, "fixed_time_step_s", "s", &SolverOptions::fixed_time_step, not_negative,
            "dt > 0: equal steps of at most this; 0: from time_step_factor and collision_steps"),
      entry(
          t, "collision_steps", "1", &SolverOptions::collision_steps, {0, 100'000},
          "dt > 0: sub-steps of a collision where collisions carry the energy, 5 or more; 0: the critical step alone, "
          "whatever collisions become"),
      entry(t, "relative_tolerance", "1", &SolverOptions::relative_tolerance, {0, 1, true, false},
            "dt = 0: error of an increment allowed, over the change of stress or a tenth of what an elastic network "
            "would answer, whichever is more; where stress is held, over the mean pressure"),
      entry(
          t, "absolute_tolerance", "1", &SolverOptions::absolute_tolerance, {0, 1, true, false},
          "dt = 0: error of an increment allowed beside that, over the mean pressure; where stress is held, the larger "
          "of the two holds"),
      entry(t, "target_unbalanced", "1", &SolverOptions::target_unbalanced, not_negative,
            "dt = 0: above 0: the unbalanced ratio that steers the number of sub-steps, instead of the tolerances"),
      entry(t, "fixed_substeps", "1", &SolverOptions::fixed_substeps, not_negative,
            "dt = 0: exactly so many sub-steps an increment of strain; 0: steered (where stress is held, always)"),
      entry(t, "max_substeps", "1", &SolverOptions::max_substeps, positive, "an increment that needs more fails"),
      entry(t, "min_height_m", "m", &SolverOptions::min_height, not_negative,
            "shortest lattice vector allowed; 0: the largest grain's diameter"),
      entry(t, "max_overlap_ratio", "1", &SolverOptions::max_overlap_ratio, positive,
            "largest overlap over the smaller radius; more fails"),
      entry(t, "ledger", "-", &SolverOptions::energy_balance, any, "keeps the energy ledger"),
  };
}

}  // namespace

const std::vector<KeyEntry>& key_entries() {
  static const std::vector<KeyEntry> all = [] {
    std::vector<KeyEntry> entries;
    for (auto list : {contacts(), damping(), solver(), materials()}) {
      entries.insert(entries.end(), list.begin(), list.end());
    }
    return entries;
  }();
  return all;
}

}  // namespace rvelab::keys
