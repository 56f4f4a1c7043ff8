// Names, ranges and mixing of contact parameters (design 6).
//
// Sources: linear law, rolling: Liang and Zhao 2019, eq. 20-28. Hertz-Mindlin: Li et al. 2023, eq. 18-21. Hertz with
// given constants: Qu, Feng and Wang, eq. 16-17. Dashpots: restitution.hpp, Tsuji, Tanaka and Ishida 1992, Brilliantov
// et al. 1996 (viscoelastic). Pair parameters decide the next bit of a specimen, so that nothing here calls the
// mathematical library but for the square root, which is correctly rounded everywhere.
#include "rvelab/contact/model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "rvelab/contact/restitution.hpp"
#include "rvelab/error.hpp"

namespace rvelab {
namespace {

constexpr std::array<std::pair<Law, const char*>, 4> law_names{{{Law::linear, "linear"},
                                                                {Law::linear_given, "linear_given"},
                                                                {Law::hertz_mindlin, "hertz_mindlin"},
                                                                {Law::hertz_given, "hertz_given"}}};
constexpr std::array<std::pair<Slip, const char*>, 3> slip_names{
    {{Slip::consistent, "consistent"},
     {Slip::full_radius, "full_radius"},
     {Slip::full_radius_ratcheting, "full_radius_ratcheting"}}};
constexpr std::array<std::pair<Dashpot, const char*>, 5> dashpot_names{{{Dashpot::none, "none"},
                                                                        {Dashpot::coefficient, "coefficient"},
                                                                        {Dashpot::restitution, "restitution"},
                                                                        {Dashpot::viscoelastic, "viscoelastic"},
                                                                        {Dashpot::tsuji, "tsuji"}}};
constexpr std::array<std::pair<LocalDampingForm, const char*>, 2> local_damping_form_names{
    {{LocalDampingForm::vector, "vector"}, {LocalDampingForm::component, "component"}}};

template <class Table, class Value>
const char* name_in(const Table& table, Value value) {
  for (const auto& [entry, text] : table) {
    if (entry == value) return text;
  }
  return "unknown";
}

template <class Table>
auto value_in(const Table& table, const char* key, const std::string& text) {
  std::string allowed;
  for (const auto& [entry, entry_name] : table) {
    if (text == entry_name) return entry;
    allowed += (allowed.empty() ? "" : ", ") + std::string(entry_name);
  }
  throw InputError(std::string(key) + " = \"" + text + "\" is not known; allowed: " + allowed +
                   "; choose one of these");
}

bool is_hertz(Law law) { return law == Law::hertz_mindlin || law == Law::hertz_given; }

/// 2ab/(a + b), zero if either is zero.
double harmonic_mean(double a, double b) { return a > 0 && b > 0 ? 2 * (a * b) / (a + b) : 0.0; }

/// Tsuji's factor alpha(e) as the polynomial that LAMMPS fits. Tsuji's mass is that of one grain, LAMMPS' the reduced
/// one, so that grains rebound faster than e says: at 0.853 of their speed for e = 0.8, at 0.44 for 0.3 (LAMMPS' own
/// records do the same). The fit leaves 3e-4 at e = 1; an elastic impact has none.
double tsuji_factor(double e) {
  if (e >= 1) return 0;
  return 1.2728 + e * (-4.2783 + e * (11.087 + e * (-22.348 + e * (27.467 + e * (-18.022 + e * 4.8218)))));
}

double dashpot_constant(Law law, const Damping& damping, double kn, double reduced_radius, double reduced_mass) {
  switch (damping.dashpot) {
    case Dashpot::none:
      return 0;
    case Dashpot::coefficient:
      return damping.normal_coefficient;
    case Dashpot::restitution:
      return (is_hertz(law) ? std::sqrt(5.0) : 2.0) * damping_ratio(damping.restitution, damping.no_tension) *
             std::sqrt(reduced_mass * kn);
    case Dashpot::tsuji:
      return tsuji_factor(damping.restitution) * std::sqrt(reduced_mass * kn);
    case Dashpot::viscoelastic:
      return damping.normal_coefficient * std::sqrt(reduced_radius) * reduced_mass;
  }
  return 0;
}

/// Collects what is wrong, in the order in which it was looked at.
class Findings {
 public:
  void add(const std::string& line) { lines_ += (lines_.empty() ? "" : "\n") + line; }

  /// One number against its range; `range` is that range in words, with the unit.
  void expect(bool allowed, const std::string& key, double value, const char* range, const char* remedy) {
    if (allowed && std::abs(value) <= std::numeric_limits<double>::max()) return;
    std::ostringstream line;
    line.precision(9);
    line << key << " = " << value << " is out of range; allowed: " << range << "; " << remedy;
    add(line.str());
  }

  void raise() const {
    if (!lines_.empty()) throw InputError(lines_);
  }

 private:
  std::string lines_;
};

void check_damping(const ContactModel& model, const Damping& damping, Findings& findings) {
  findings.expect(damping.local >= 0 && damping.local < 1, "damping.local", damping.local, "0 to below 1",
                  "give 0 for no local damping in loading at a rate");
  findings.expect(damping.local_quasi_static > 0 && damping.local_quasi_static < 1, "damping.local_quasi_static",
                  damping.local_quasi_static, "above 0 to below 1", "give 0.3, the default");
  findings.expect(damping.global_viscous >= 0, "damping.global_viscous", damping.global_viscous, ">= 0 N s/m",
                  "give 0 for none");
  if (damping.dashpot == Dashpot::none) return;
  findings.expect(damping.tangential_ratio >= 0, "damping.tangential_ratio", damping.tangential_ratio, ">= 0",
                  "give 0 for a normal dashpot alone");
  if (damping.dashpot == Dashpot::coefficient) {
    findings.expect(damping.normal_coefficient >= 0, "damping.normal_coefficient", damping.normal_coefficient,
                    ">= 0 N s/m", "give the dashpot coefficient, or damping.dashpot = none");
  }
  if (damping.dashpot == Dashpot::tsuji && !is_hertz(model.law)) {
    findings.add("damping.dashpot = tsuji does not go with contact.law = " + std::string(name(model.law)) +
                 "; allowed: hertz_mindlin, hertz_given; use damping.dashpot = restitution");
  }
  if (damping.dashpot == Dashpot::restitution || damping.dashpot == Dashpot::tsuji) {
    findings.expect(damping.restitution > 0 && damping.restitution <= 1, "damping.restitution", damping.restitution,
                    "above 0 to 1", "give the coefficient of restitution of two grains; 1 is elastic");
  }
  if (damping.dashpot == Dashpot::viscoelastic) {
    if (!is_hertz(model.law)) {
      findings.add("damping.dashpot = viscoelastic does not go with contact.law = " + std::string(name(model.law)) +
                   "; allowed: hertz_mindlin, hertz_given; use damping.dashpot = restitution or coefficient");
    }
    findings.expect(damping.normal_coefficient >= 0, "damping.normal_coefficient", damping.normal_coefficient,
                    ">= 0 1/(m s)", "give the viscoelastic constant, or damping.dashpot = none");
  }
}

void check_material(const ContactModel& model, const Material& material, Findings& findings) {
  const auto key = [&](const char* field) { return "material \"" + material.name + "\": " + field; };
  findings.expect(material.density > 0, key("density"), material.density, "> 0 kg/m^3",
                  "give the density of the solid, 2650 for quartz");
  if (model.law == Law::linear || model.law == Law::hertz_mindlin) {
    findings.expect(material.young_modulus > 0, key("young_modulus"), material.young_modulus, "> 0 Pa",
                    "give the contact modulus E");
  }
  if (model.law == Law::linear) {
    findings.expect(material.stiffness_ratio >= 0 && material.stiffness_ratio <= 10, key("stiffness_ratio"),
                    material.stiffness_ratio, "0 to 10", "give kt/kn of the linear law");
  }
  if (model.law == Law::hertz_mindlin) {
    findings.expect(material.poisson_ratio >= -0.99 && material.poisson_ratio <= 0.5, key("poisson_ratio"),
                    material.poisson_ratio, "-0.99 to 0.5", "give Poisson's ratio of the grains, 0.25 for quartz");
  }
  if (model.law == Law::linear_given || model.law == Law::hertz_given) {
    const bool linear = model.law == Law::linear_given;
    findings.expect(material.normal_stiffness > 0, key("normal_stiffness"), material.normal_stiffness,
                    linear ? "> 0 N/m" : "> 0 N/m^1.5", "give the normal stiffness of a contact");
    findings.expect(material.tangential_stiffness >= 0, key("tangential_stiffness"), material.tangential_stiffness,
                    ">= 0 N/m", "give the tangential stiffness of a contact, 0 for none");
  }
  findings.expect(material.friction >= 0 && material.friction <= 1e6, key("friction"), material.friction, "0 to 1e6",
                  "give mu, the tangent of the contact friction angle; 1e6 means no slip");
  if (model.rolling) {
    findings.expect(material.rolling_stiffness >= 0, key("rolling_stiffness"), material.rolling_stiffness, ">= 0",
                    "give beta of k_r = kt ri rj beta, or contact.rolling = false");
    findings.expect(material.rolling_friction >= 0, key("rolling_friction"), material.rolling_friction, ">= 0",
                    "give eta of the moment cap, or contact.rolling = false");
  }
}

}  // namespace

double dashpot_power(Law law, Dashpot dashpot) {
  if (dashpot == Dashpot::viscoelastic) return 0.5;
  return (dashpot == Dashpot::restitution || dashpot == Dashpot::tsuji) && is_hertz(law) ? 0.25 : 0.0;
}

PairParameters mix(const ContactModel& model, const Damping& damping, const Material& a, double ri, double mi,
                   const Material& b, double rj, double mj) {
  const double reduced_radius = ri * rj / (ri + rj);
  const double reduced_mass = mi * mj / (mi + mj);
  PairParameters pair;
  switch (model.law) {
    case Law::linear: {
      const double ei = a.young_modulus * ri, ej = b.young_modulus * rj;
      pair.kn = harmonic_mean(ei, ej);
      pair.kt = harmonic_mean(ei * a.stiffness_ratio, ej * b.stiffness_ratio);
      break;
    }
    case Law::linear_given:
    case Law::hertz_given:
      pair.kn = harmonic_mean(a.normal_stiffness, b.normal_stiffness);
      pair.kt = harmonic_mean(a.tangential_stiffness, b.tangential_stiffness);
      break;
    case Law::hertz_mindlin: {
      const auto compression = [](const Material& m) {
        return (1 - m.poisson_ratio * m.poisson_ratio) / m.young_modulus;
      };
      const auto shear = [](const Material& m) {
        return 2 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio) / m.young_modulus;
      };
      const double root = std::sqrt(reduced_radius);
      pair.kn = 4 * root / (3 * (compression(a) + compression(b)));
      pair.kt = 8 * root / (shear(a) + shear(b));
      break;
    }
  }
  pair.friction = std::min(a.friction, b.friction);
  if (model.rolling) {
    pair.kr = pair.kt * (ri * rj) * harmonic_mean(a.rolling_stiffness, b.rolling_stiffness);
    pair.moment_cap = std::min(a.rolling_friction * ri, b.rolling_friction * rj);
  }
  pair.cn = dashpot_constant(model.law, damping, pair.kn, reduced_radius, reduced_mass);
  return pair;
}

void check(const ContactModel& model, const Damping& damping, const std::vector<Material>& materials) {
  Findings findings;
  check_damping(model, damping, findings);
  if (materials.empty()) findings.add("materials: none given; allowed: one or more; name at least one grain material");
  for (const Material& material : materials) check_material(model, material, findings);
  findings.raise();
}

const char* name(Law law) { return name_in(law_names, law); }
const char* name(Slip slip) { return name_in(slip_names, slip); }
const char* name(Dashpot dashpot) { return name_in(dashpot_names, dashpot); }
const char* name(LocalDampingForm form) { return name_in(local_damping_form_names, form); }

Law law_from(const std::string& text) { return value_in(law_names, "contact.law", text); }
Slip slip_from(const std::string& text) { return value_in(slip_names, "contact.slip", text); }
Dashpot dashpot_from(const std::string& text) { return value_in(dashpot_names, "damping.dashpot", text); }
LocalDampingForm local_damping_form_from(const std::string& text) {
  return value_in(local_damping_form_names, "damping.local_form", text);
}

}  // namespace rvelab
