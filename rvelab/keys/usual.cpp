// Values that are allowed and unusual, and the unit that they are likely in. Declared in key.hpp.
#include <cmath>
#include <cstdio>

#include "rvelab/error.hpp"
#include "rvelab/keys/key.hpp"

namespace rvelab::keys {
namespace {

/// A unit in which a number may have been given, and what one of it is in the unit of the key.
struct Likely {
  const char *asked, *given;
  double factor;
};

constexpr Likely likely_units[] = {{"Pa", "kPa", 1e3},
                                   {"Pa", "MPa", 1e6},
                                   {"Pa", "GPa", 1e9},
                                   {"m", "mm", 1e-3},
                                   {"m", "um", 1e-6},
                                   {"mm", "m", 1e3},
                                   {"mm", "um", 1e-3},
                                   {"kg/m^3", "g/cm^3", 1e3},
                                   {"kg/m^3", "g/m^3", 1e-3},
                                   {"kg/m^3", "t/mm^3", 1e12},
                                   {"N/m", "kN/m", 1e3},
                                   {"N/m", "MN/m", 1e6},
                                   {"N/m^1.5", "kN/m^1.5", 1e3},
                                   {"N/m^1.5", "MN/m^1.5", 1e6},
                                   {"degree", "radians", 57.29577951308232},
                                   {"1", "per cent", 0.01}};

std::string rounded(double value, const char* format = "%.4g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

bool is_coefficient(const Key& key) { return key.unit == "1" && key.name.ends_with("friction"); }

/// A coefficient that is likely an angle, or an angle that is likely a coefficient; "" if neither.
std::string as_other_friction(const Key& key, double value) {
  constexpr double degree = 3.14159265358979323846 / 180;
  if (is_coefficient(key) && value > 2 && value < 90)
    return "likely an angle in degrees: its tangent is " + rounded(std::tan(value * degree)) +
           (key.name == "friction" && key.table == "material" ? ", write that, or friction_angle_deg" : ", write that");
  if (key.name == "friction_angle_deg" && value > 0 && value < 1)
    return "likely a coefficient, or in radians: write friction = " + rounded(value) + ", or " +
           rounded(value / degree) + " degrees";
  return "";
}

}  // namespace

std::string usual_in_words(const Key& key) {
  if (!key.usual.is_stated()) return "";
  const std::string unit = key.unit == "-" || key.unit == "1" ? "" : " " + key.unit;
  const std::string again = key.usual.again_from < no_bound ? ", or from " + rounded(key.usual.again_from) + " on" : "";
  return in_words(key.usual.values) + unit + again;
}

std::string likely_unit(const std::string& unit, double value, const Usual& usual) {
  std::string units, values;
  for (const Likely& likely : likely_units) {
    const double meant = value * likely.factor;
    if (unit != likely.asked || !usual.holds(meant)) continue;
    units += (units.empty() ? "" : " or ") + std::string(likely.given);
    values += (values.empty() ? "" : " or ") + rounded(meant);
  }
  return units.empty() ? "check its unit" : "likely in " + units + ": write " + values;
}

std::string unusual_in(const Key& key, double value) {
  if (key.usual.holds(value)) return "";
  const std::string friction = as_other_friction(key, value);
  return "is unusual; usual: " + usual_in_words(key) + "; " +
         (friction.empty() ? likely_unit(key.unit, value, key.usual) : friction);
}

}  // namespace rvelab::keys
