// The table of keys of materials, contact, damping and solver. Declared in material_toml.hpp.
#include "rvelab/keys/material_toml.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/specimen/field_layout.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::keys {
namespace {

constexpr Interval any{0, 0};  // of what is no number

Choices split(const std::string& names) {
  Choices words;
  for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + 2) {
    end = names.find(", ", at);
    words.push_back(names.substr(at, end - at));
  }
  return words;
}

/// The words of an enumeration; none: it is none.
template <class Value>
Choices words_of() {
  if constexpr (std::is_same_v<Value, Law>) return split(law_names());
  if constexpr (std::is_same_v<Value, Slip>) return {"consistent", "full_radius", "full_radius_ratcheting"};
  if constexpr (std::is_same_v<Value, HertzRadius>) return {"equivalent", "curvature"};
  if constexpr (std::is_same_v<Value, Dashpot>) return {"none", "coefficient", "restitution", "viscoelastic", "tsuji"};
  if constexpr (std::is_same_v<Value, LocalDampingForm>) return {"vector", "component"};
  return {};
}

/// The default is that of the struct: it is written nowhere twice.
template <class Owner, class Value>
KeyEntry entry(const char* table, const char* name, const char* unit, Value Owner::*member, const Interval& range,
               const std::string& meaning, const Usual& usual = {}) {
  const Value initial = Owner{}.*member;
  Key key{table, name, unit, "number", "", in_words(range), meaning, range, words_of<Value>(), false, usual};
  if constexpr (std::is_same_v<Value, bool>) {
    key.type = "boolean";
    key.initial = initial ? "true" : "false";
    key.range = "true, false";
  } else if constexpr (std::is_arithmetic_v<Value>) {
    if (std::is_same_v<Value, long>) key.type = "whole number";
    key.initial = as_toml(double(initial));
  } else {
    key.type = key.choices.empty() ? "text" : "choice";
    key.initial = as_toml(fields::text_of(initial));
    key.range = key.choices.empty() ? "any text, different for each material" : listed(key.choices);
  }
  return {key, member};
}

/// What laws mean by a number that they read: "linear_stiffness, hertz_stiffness: kt".
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

/// Moduli from a gel to diamond, stiffnesses of contacts of such grains from 1e-6 to 1 m; roughness from polished glass
/// to gravel.
Usual usual_of(const std::string& unit) {
  if (unit == "Pa") return {{1e4, 2e12}};
  if (unit == "N/m" || unit == "N/m^1.5") return {{1e-2, 1e15}};
  if (unit == "m") return {{1e-10, 1e-4}};
  return {};
}

/// A key for each number that laws read.
std::vector<KeyEntry> law_constants() {
  std::vector<KeyEntry> entries;
  for (const LawParameter& each : law_parameters()) {
    const Parameter& p = each.parameter;
    const auto same = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.key.name == p.key; });
    if (same != entries.end()) continue;
    const bool is_stiffness = p.allowed.low_open;  // a law may do without the others
    entries.push_back(entry("material", p.key, p.unit, each.value, p.allowed, meaning_of(p.key),
                            is_stiffness ? usual_of(p.unit) : Usual{}));
  }
  return entries;
}

std::vector<KeyEntry> materials() {
  const char* t = "material";
  constexpr Interval angle{0, 90, false, true};
  std::vector<KeyEntry> entries = {
      entry(t, "name", "-", &Material::name, any, "name of the material, for --set material.NAME.key"),
      entry(t, "density_kg_m3", "kg/m^3", &Material::density, positive, "density of the solid",
            {{10, 2.5e4}})};  // foam to osmium
  const std::vector<KeyEntry> constants = law_constants();
  entries.insert(entries.end(), constants.begin(), constants.end());
  const std::vector<KeyEntry> surface = {
      entry(t, "friction", "1", &Material::friction, {0, 1e6}, "Coulomb coefficient mu; 1e6: no slip", friction_values),
      {{t,
        "friction_angle_deg",
        "degree",
        "number",
        "",
        in_words(angle),
        "in place of friction: mu is its tangent",
        angle,
        {},
        false,
        {{1, 75}}},
       &Material::friction,
       true},
      entry(t, "rolling_stiffness", "1", &Material::rolling_stiffness, not_negative, "beta of k_r = kt ri rj beta"),
      entry(t, "rolling_friction", "1", &Material::rolling_friction, not_negative,
            "eta of the moment cap min(eta_i ri, eta_j rj) fn", friction_values),
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
            "hertz_mindlin, hertz_rough, cones: the tangential force falls with its stiffness on unloading"),
      entry(t, "hertz_radius", "-", &ContactModel::hertz_radius, any,
            "hertz_mindlin, ellipses and superellipsoids: radius of the law: that of the disc or sphere of the same "
            "size, or "
            "of the curvature at the contact, which conserves no energy"),
  };
}

std::vector<KeyEntry> damping() {
  const char* t = "damping";
  return {
      entry(t, "local", "1", &Damping::local, below_one, "Cundall's damping at a rate"),
      entry(t, "local_quasi_static", "1", &Damping::local_quasi_static, ratio,
            "Cundall's damping in quasi-static loading"),
      entry(t, "local_form", "-", &Damping::local_form, any, "component: as in YADE, depends on the axes"),
      entry(t, "dashpot", "-", &Damping::dashpot, any, "contact dashpot; acts at a rate only"),
      entry(t, "normal_coefficient_N_s_m", "N s/m", &Damping::normal_coefficient, not_negative,
            "dashpot = coefficient: c_n"),
      entry(t, "viscoelastic_1_m_s", "1/(m s)", &Damping::normal_coefficient, not_negative,
            "dashpot = viscoelastic: eta of c_n = eta sqrt(r* overlap) m*"),
      entry(t, "restitution", "1", &Damping::restitution, {0, 1, true, false},
            "dashpot = restitution: coefficient of restitution of two grains, any law; tsuji: e of LAMMPS' "
            "polynomial, Hertz only (grains rebound at 0.85 for 0.8, 0.44 for 0.3)"),
      entry(t, "tangential_ratio", "1", &Damping::tangential_ratio, not_negative,
            "tangential over normal dashpot coefficient"),
      entry(t, "no_tension", "-", &Damping::no_tension, any, "cuts the normal force at zero: a dashpot never attracts"),
      entry(t, "global_viscous_N_s_m", "N s/m", &Damping::global_viscous, not_negative,
            "force -c v' on each grain, at a rate only"),
  };
}

std::vector<KeyEntry> solver() {
  const char* t = "solver";
  return {
      entry(t, "skin", "1", &SolverOptions::skin, {0, largest_skin_ratio, true, false},
            "largest Verlet skin over the mean radius; rvelab reduces it to what is fastest"),
      entry(t, "time_step_factor", "1", &SolverOptions::time_step_factor, ratio,
            "fraction of the critical step 2/omega_max"),
      entry(t, "fixed_time_step_s", "s", &SolverOptions::fixed_time_step, not_negative,
            "at a rate: equal steps of at most this; 0: from time_step_factor and collision_steps"),
      entry(t, "collision_steps", "1", &SolverOptions::collision_steps, {0, 100'000},
            "at a rate: sub-steps per collision where collisions carry the energy, 5 or more; 0: the critical step "
            "alone, "
            "which may not resolve collisions"),
      entry(t, "relative_tolerance", "1", &SolverOptions::relative_tolerance, {0, 1, true, false},
            "quasi-static: allowed error of the stress, over the larger of its change in the increment and a tenth of "
            "the "
            "change of an elastic network; under stress control: over the mean pressure"),
      entry(t, "absolute_tolerance", "1", &SolverOptions::absolute_tolerance, {0, 1, true, false},
            "quasi-static: allowed error in addition to that, over the mean pressure; under stress control: the larger "
            "of "
            "the two tolerances"),
      entry(t, "target_unbalanced", "1", &SolverOptions::target_unbalanced, not_negative,
            "quasi-static: if above 0, this unbalanced ratio determines the number of sub-steps, instead of the "
            "tolerances"),
      entry(
          t, "fixed_substeps", "1", &SolverOptions::fixed_substeps, not_negative,
          "quasi-static: number of sub-steps of every increment of strain; 0: by error control, as always under stress "
          "control"),
      entry(t, "max_substeps", "1", &SolverOptions::max_substeps, positive, "an increment that needs more fails"),
      entry(t, "min_height_m", "m", &SolverOptions::min_height, not_negative,
            "shortest lattice vector allowed; 0: the largest grain's diameter"),
      entry(t, "max_overlap_ratio", "1", &SolverOptions::max_overlap_ratio, positive,
            "largest overlap over the smaller radius; more fails"),
      entry(t, "energy_balance", "-", &SolverOptions::energy_balance, any, "computes the energy balance"),
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
