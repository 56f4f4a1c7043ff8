// Names, ranges and mixing of contact parameters. What a law reads and makes of it stands in its own file (laws.hpp).
//
// Sources: rolling: Liang and Zhao 2019, eq. 24-28. Dashpots: impact.hpp, Tsuji, Tanaka and Ishida 1992,
// Brilliantov et al. 1996 (viscoelastic). Pair parameters decide the next bit of a specimen, so that nothing here calls
// the mathematical library but for the square root, which is correctly rounded everywhere.
#include "rvelab/contact/model.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>

#include "rvelab/contact/impact.hpp"
#include "rvelab/error.hpp"

namespace rvelab {
namespace {

bool is_hertz(Law law) {
  return with_law(law, [](auto each) { return decltype(each)::Force::is_hertz; });
}

/// Whether r* of the grains is part of a law's constants.
bool has_hertz_radius(Law law) {
  return with_law(law, [](auto each) { return decltype(each)::Force::has_hertz_radius; });
}

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
      return with_law(law, [](auto each) { return decltype(each)::Force::Impact::restitution_factor; }) *
             damping_ratio(damping.restitution, damping.no_tension) * std::sqrt(reduced_mass * kn);
    case Dashpot::tsuji:
      return tsuji_factor(damping.restitution) * std::sqrt(reduced_mass * kn);
    case Dashpot::viscoelastic:
      return damping.normal_coefficient * std::sqrt(reduced_radius) * reduced_mass;
  }
  return 0;
}

/// Collects what is wrong, in the order of the checks.
class Findings {
 public:
  void add(const std::string& line) { lines_ += (lines_.empty() ? "" : "\n") + line; }

  /// One number against its range, in this unit.
  void expect(const Interval& range, const std::string& key, double value, const std::string& unit,
              const char* remedy) {
    if (range.contains(value) && std::abs(value) <= std::numeric_limits<double>::max()) return;
    char digits[32];  // as many as tell it from the end of the range
    const std::string found(digits, std::to_chars(std::begin(digits), std::end(digits), value).ptr);
    add(key + " = " + found + " is out of range; allowed: " + in_words(range) + (unit.empty() ? "" : " " + unit) +
        "; " + remedy);
  }

  void raise() const {
    if (!lines_.empty()) throw InputError(lines_);
  }

 private:
  std::string lines_;
};

void check_damping(const ContactModel& model, const Damping& damping, Findings& findings) {
  findings.expect(ranges::local_damping, "damping.local", damping.local, "",
                  "give 0 for no local damping in loading at a rate");
  findings.expect(ranges::local_damping_quasi_static, "damping.local_quasi_static", damping.local_quasi_static, "",
                  "give 0.3, the default");
  findings.expect(number_from_zero, "damping.global_viscous", damping.global_viscous, "N s/m", "give 0 for none");
  if (damping.dashpot == Dashpot::none) return;
  findings.expect(number_from_zero, "damping.tangential_ratio", damping.tangential_ratio, "",
                  "give 0 for a normal dashpot alone");
  const bool viscoelastic = damping.dashpot == Dashpot::viscoelastic;
  if ((viscoelastic || damping.dashpot == Dashpot::tsuji) && !is_hertz(model.law))
    findings.add(std::string("damping.dashpot = ") + name(damping.dashpot) +
                 " does not go with contact.law = " + name(model.law) + "; allowed: " + names_where<Law>(is_hertz) +
                 "; use damping.dashpot = restitution" + (viscoelastic ? " or coefficient" : ""));
  if (viscoelastic || damping.dashpot == Dashpot::coefficient)
    findings.expect(number_from_zero, "damping.normal_coefficient", damping.normal_coefficient,
                    viscoelastic ? "1/(m s)" : "N s/m",
                    viscoelastic ? "give the viscoelastic constant, or damping.dashpot = none"
                                 : "give the dashpot coefficient, or damping.dashpot = none");
  if (damping.dashpot == Dashpot::restitution || damping.dashpot == Dashpot::tsuji)
    findings.expect(ranges::restitution, "damping.restitution", damping.restitution, "",
                    "give the coefficient of restitution of two grains; 1 is elastic");
}

void check_material(const ContactModel& model, const Material& material, Findings& findings) {
  const auto key = [&](const char* field) { return "material \"" + material.name + "\": " + field; };
  findings.expect(ranges::density, key("density"), material.density, "kg/m^3",
                  "give the density of the solid, 2650 for quartz");
  for (const LawParameter& each : law_parameters()) {
    if (each.law != model.law) continue;
    const Parameter& p = each.parameter;
    findings.expect(p.allowed, key(p.field), material.*each.value, p.unit == std::string("1") ? "" : p.unit, p.remedy);
  }
  findings.expect(ranges::friction, key("friction"), material.friction, "",
                  "give mu, the tangent of the contact friction angle; 1e6 means no slip");
  if (model.rolling) {
    findings.expect(number_from_zero, key("rolling_stiffness"), material.rolling_stiffness, "",
                    "give beta of k_r = kt ri rj beta, or contact.rolling = false");
    findings.expect(number_from_zero, key("rolling_friction"), material.rolling_friction, "",
                    "give eta of the moment cap, or contact.rolling = false");
  }
}

}  // namespace

double dashpot_power(Law law, Dashpot dashpot) {
  if (dashpot == Dashpot::viscoelastic) return 0.5;
  if (dashpot != Dashpot::restitution && dashpot != Dashpot::tsuji) return 0;
  return 0.25 * with_law(law, [](auto each) { return decltype(each)::Force::Impact::restitution_quarters; });
}

const std::vector<LawParameter>& law_parameters() {
  static const std::vector<LawParameter> all = [] {
    std::vector<LawParameter> found;
    for (int k = 0; k < law_count; ++k)
      with_law(Law(k), [&](auto law) {
        decltype(law)::parameters([&](const Parameter& parameter, auto value) {
          found.push_back({Law(k), parameter, value});
        });
      });
    return found;
  }();
  return all;
}

PairParameters mix(const ContactModel& model, const Damping& damping, const Material& a, double ri, double mi,
                   const Material& b, double rj, double mj, double section) {
  const double reduced_radius = ri * rj / (ri + rj);
  const double reduced_mass = mi * mj / (mi + mj);
  PairParameters pair{with_law(model.law, [&](auto law) { return decltype(law)::mix(a, ri, b, rj, section); })};
  pair.friction = std::min(a.friction, b.friction);
  if (model.rolling) {
    pair.kr = pair.kt * (ri * rj) * harmonic_mean(a.rolling_stiffness, b.rolling_stiffness);
    pair.moment_cap = std::min(a.rolling_friction * ri, b.rolling_friction * rj);
  }
  pair.cn = dashpot_constant(model.law, damping, pair.kn, reduced_radius, reduced_mass);
  return pair;
}

void check_parameters(const ContactModel& model, const Damping& damping, const std::vector<Material>& materials) {
  Findings findings;
  if (model.hertz_radius == HertzRadius::curvature && !has_hertz_radius(model.law))
    findings.add("contact.hertz_radius = \"curvature\" does not go with contact.law = " + std::string(name(model.law)) +
                 ", whose stiffness holds no radius of Hertz; allowed: " + names_where<Law>(has_hertz_radius) +
                 "; use contact.hertz_radius = \"equivalent\"");
  check_damping(model, damping, findings);
  if (materials.empty()) findings.add("materials: none given; allowed: one or more; name at least one grain material");
  for (const Material& material : materials) check_material(model, material, findings);
  findings.raise();
}

}  // namespace rvelab
