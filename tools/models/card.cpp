#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "tools/models/models.hpp"

namespace rvelab::models {
namespace {

double value_of(const Fit& fit, const std::string& name) {
  for (const Parameter& parameter : fit.parameters)
    if (parameter.name == name) return parameter.value;
  throw InputError("the fit of " + fit.model + " has no parameter " + name);
}

/// To six digits, with a point: these hosts read 1e+06, and 30. as a number that is not whole.
std::string number(double value) {
  std::string text = in_words(value);
  if (text.find_first_of(".e") == std::string::npos) text += '.';
  return text;
}

/// Keywords of Abaqus, which CalculiX reads since 2.21 (its source: mohrcoulombs.f, mohrcoulombhardenings.f).
std::string mohr_coulomb_card(const Fit& fit, bool abaqus) {
  TextStream text;
  text << "** " << fit.model << " of a data sheet; m, N, Pa. A cohesion of 100 Pa keeps the apex away.\n";
  text << "*MATERIAL, NAME=SOIL\n*ELASTIC\n"
       << number(value_of(fit, "E")) << ", " << number(value_of(fit, "nu")) << '\n';
  const double psi = value_of(fit, "psi");
  if (abaqus && psi < 0) text << "** psi = " << in_words(psi) << " was fitted; Abaqus wants 0 at least\n";
  text << "*MOHR COULOMB\n"
       << number(value_of(fit, "phi")) << ", " << number(abaqus ? std::max(psi, 0.0) : psi) << '\n';
  // Two rows in CalculiX, as in its own test mohr1.inp.
  text << "*MOHR COULOMB HARDENING\n100., 0.\n" << (abaqus ? "" : "100., 1.\n");
  return text.str();
}

/// Names that codes use: Plaxis for Hardening Soil, the publications for the others.
std::string other_name(const std::string& name) {
  static const std::map<std::string, std::string> names{
      {"phi", "phi'"},    {"E50_ref", "E50ref"}, {"Eoed_ref", "Eoedref"}, {"Eur_ref", "Eurref"},   {"m", "power (m)"},
      {"nu_ur", "nu'ur"}, {"R_f", "Rf"},         {"G0_ref", "G0ref"},     {"gamma_07", "gamma0.7"}};
  const auto found = names.find(name);
  return found == names.end() ? name : found->second;
}

std::string table(const Fit& fit) {
  TextStream text;
  text << "# " << fit.model << "; low and high: 95 % interval of what was fitted\n";
  for (const std::string& remark : fit.remarks) text << "# " << remark << '\n';
  text << "# parameter, unit, value, low, high, origin, meaning\n";
  for (const Parameter& parameter : fit.parameters) {
    const bool stress = parameter.unit == "Pa";
    const double unit = stress ? 1e-3 : 1;
    const auto cell = [&](double value) { return std::isfinite(value) ? in_words(unit * value) : std::string(); };
    text << other_name(parameter.name) << ", " << (stress ? "kPa" : parameter.unit) << ", " << cell(parameter.value)
         << ", " << cell(parameter.low) << ", " << cell(parameter.high) << ", " << name_of(parameter.origin) << ", "
         << parameter.meaning << '\n';
  }
  if (fit.model == "Hardening Soil small")
    text << "pref, kPa, 100, , , sheet, reference stress\nc', kPa, 0, , , assumed, cohesion\n";
  return text.str();
}

}  // namespace

std::string card(const Fit& fit, std::string_view host) {
  if (host == "table") return table(fit);
  if (host != "abaqus" && host != "calculix")
    throw InputError("host is '" + std::string(host) + "'; choose one of abaqus, calculix, table");
  return fit.model == "Mohr-Coulomb" ? mohr_coulomb_card(fit, host == "abaqus") : "";
}

}  // namespace rvelab::models
