#include "rvelab/fit/column_kinds.hpp"

#include <cctype>
#include <map>
#include <string_view>

namespace rvelab::fit {
namespace {

/// Names without their unit, in small letters with one underscore between words.
const std::map<std::string, std::string>& quantities() {
  static const std::map<std::string, std::string> all{{"axial_strain", "strain"},
                                                      {"shear_strain", "strain"},
                                                      {"vertical_strain", "strain"},
                                                      {"eps_a", "strain"},
                                                      {"eps_1", "strain"},
                                                      {"eps1", "strain"},
                                                      {"epsilon_a", "strain"},
                                                      {"epsilon_1", "strain"},
                                                      {"\xce\xb5_a", "strain"},
                                                      {"\xce\xb5_1", "strain"},
                                                      {"axial_stress", "axial_stress"},
                                                      {"vertical_stress", "axial_stress"},
                                                      {"sigma_1", "axial_stress"},
                                                      {"sigma_a", "axial_stress"},
                                                      {"sigma_v", "axial_stress"},
                                                      {"effective_vertical_stress", "axial_stress"},
                                                      {"vertical_effective_stress", "axial_stress"},
                                                      {"p", "p"},
                                                      {"p'", "p"},
                                                      {"mean_stress", "p"},
                                                      {"mean_effective_stress", "p"},
                                                      {"q", "deviator"},
                                                      {"deviator", "deviator"},
                                                      {"deviator_stress", "deviator"},
                                                      {"deviatoric_stress", "deviator"},
                                                      {"q_over_p", "q_over_p"},
                                                      {"q/p", "q_over_p"},
                                                      {"eta", "q_over_p"},
                                                      {"volumetric_strain", "volumetric_strain"},
                                                      {"eps_v", "volumetric_strain"},
                                                      {"epsilon_v", "volumetric_strain"},
                                                      {"eps_vol", "volumetric_strain"},
                                                      {"\xce\xb5_v", "volumetric_strain"},
                                                      {"volume_strain", "volumetric_strain"},
                                                      {"void_ratio", "void_ratio"},
                                                      {"e", "void_ratio"}};
  return all;
}

bool is_of_stress(const std::string& unit) { return unit.ends_with("pa") || unit.starts_with("kn/m"); }

/// Factor of a unit to SI; none: no unit.
std::optional<double> factor_of(const std::string& unit) {
  static const std::map<std::string, double> all{
      {"pa", 1},         {"kpa", 1e3}, {"mpa", 1e6}, {"kn/m2", 1e3}, {"kn/m\xc2\xb2", 1e3},
      {"percent", 0.01}, {"%", 0.01},  {"-", 1},     {"1", 1}};
  const auto found = all.find(unit);
  return found == all.end() ? std::nullopt : std::optional(found->second);
}

struct NameAndUnit {
  std::string name, unit;
};

/// "Eps a [%]" is eps_a and %, "deviator_kPa" is deviator and kpa.
NameAndUnit parted(const std::string& text) {
  std::string plain;
  for (const char letter : text) {
    const bool blank = letter == ' ' || letter == '\t';
    if (!blank)
      plain += char(std::tolower(static_cast<unsigned char>(letter)));
    else if (!plain.empty() && plain.back() != '_')
      plain += '_';
  }
  const auto without_end = [](std::string name) {
    while (!name.empty() && (name.back() == '_' || name.back() == ',')) name.pop_back();
    return name;
  };
  for (const std::string_view brackets : {"[]", "()"}) {
    const auto open = plain.rfind(brackets[0]), close = plain.rfind(brackets[1]);
    if (open != std::string::npos && close == plain.size() - 1 && open < close)
      return {without_end(plain.substr(0, open)), plain.substr(open + 1, close - open - 1)};
  }
  const auto last = plain.rfind('_');
  if (last != std::string::npos && factor_of(plain.substr(last + 1)) && plain.substr(last + 1).size() > 1)
    return {plain.substr(0, last), plain.substr(last + 1)};
  return {plain, ""};
}

}  // namespace

std::optional<ColumnKind> column_kind(const std::string& name, const std::string& below) {
  auto [own, unit] = parted(name);
  if (unit.empty() && !below.empty()) unit = parted("x [" + below + "]").unit;
  const auto found = quantities().find(own);
  if (found == quantities().end()) return std::nullopt;
  ColumnKind kind{found->second};
  const auto factor = factor_of(unit);
  if (!unit.empty() && (!factor || is_of_stress(unit) != kind.is_stress())) return std::nullopt;
  kind.factor = factor.value_or(kind.is_stress() ? 0 : 1);
  return kind;
}

std::string known_columns(bool abscissa) {
  return abscissa
             ? "axial_strain, axial_strain_percent, shear_strain, p_kPa, axial_stress_kPa"
             : "q_over_p, deviator_kPa, p_kPa, volumetric_strain, volumetric_strain_percent, axial_strain_percent, "
               "void_ratio";
}

bool may_be_abscissa(const ColumnKind& kind) {
  return kind.quantity == "strain" || kind.quantity == "p" || kind.quantity == "axial_stress";
}
bool may_be_curve(const ColumnKind& kind) { return kind.quantity != "axial_stress"; }

}  // namespace rvelab::fit
