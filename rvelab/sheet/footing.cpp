// Bearing capacity of a strip footing, and the geometry of its failure mechanism.
//
//   sin phi = sum s t/sum s^2      over the peaks at all pressures: the secant through the origin, s = (sigma_1 +
//                                  sigma_3)/2, t = (sigma_1 - sigma_3)/2
//   N_q = tan^2(45 + phi/2) exp(pi tan phi), N_c = (N_q - 1) cot phi     (Prandtl 1920, Reissner 1924)
//   N_gamma = 2 (N_q + 1) tan phi                                       (Vesic 1973)
//   wedges 45 + phi/2 (active) and 45 - phi/2 (passive), spiral exp(pi/2 tan phi)
// Each follows from the angle alone: its interval is what it is at the ends of that of the angle, its standard error
// and error of calculation half of the difference over one such error of the angle to both sides.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/ensemble/measures.hpp"
#include "rvelab/sheet/groups.hpp"

namespace rvelab::sheet {
namespace {

constexpr const char* footing_group = "Strip footing";
constexpr About secant_angle{footing_group,
                             "secant_friction_angle_deg",
                             "friction angle of all pressures",
                             "degrees",
                             "sin \u03c6 = \u03a3st/\u03a3s\u00b2 over the peaks, through the origin",
                             "Mohr and Coulomb"};

double passive_wedge(double angle) { return 45 - angle / 2; }

struct Factor {
  About about;
  double (*of)(double angle_deg);
};
constexpr Factor factors[] = {
    {{footing_group, "bearing_capacity_Nq", "N_q", "", "tan\u00b2(45\u00b0 + \u03c6/2) exp(\u03c0 tan \u03c6)",
      "Prandtl 1920, Reissner 1924"},
     calibrate::bearing_capacity_Nq},
    {{footing_group, "bearing_capacity_Nc", "N_c", "", "(N_q \u2212 1) cot \u03c6", "Prandtl 1920"},
     calibrate::bearing_capacity_Nc},
    {{footing_group, "bearing_capacity_Ngamma", "N_\u03b3", "", "2 (N_q + 1) tan \u03c6", "Vesic 1973"},
     ensemble::bearing_capacity_Ngamma},
    {{footing_group, "active_wedge_deg", "active wedge", "degrees", "45\u00b0 + \u03c6/2 against the horizontal",
      "Prandtl 1920"},
     calibrate::wedge_angle_deg},
    {{footing_group, "passive_wedge_deg", "passive wedge", "degrees", "45\u00b0 \u2212 \u03c6/2 against the horizontal",
      "Prandtl 1920"},
     passive_wedge},
    {{footing_group, "spiral_ratio", "spiral, end radius over first", "", "exp(\u03c0/2 tan \u03c6)", "Prandtl 1920"},
     ensemble::spiral_ratio}};

Number factor_of(const Factor& factor, const Number& angle) {
  const About& about = factor.about;
  Number number = angle;
  number.key = about.key;
  number.label = about.label + std::string(angle.key == secant_angle.key ? "" : ", by \u03c6_cs");
  number.unit = about.unit;
  number.group = about.group;
  number.definition = about.definition;
  number.source = about.source;
  number.published = unknown;
  number.published_by.clear();
  const auto reach = [&](double error) {
    return 0.5 * std::abs(factor.of(angle.mean + error) - factor.of(angle.mean - error));
  };
  number.mean = factor.of(angle.mean);
  number.standard_error = reach(angle.standard_error);
  number.calculation_error = reach(angle.calculation_error);
  // Two specimens that differ may have an interval that leaves the angles of soils.
  const auto at = [&](double end) { return end >= 0 && end < 90 ? factor.of(end) : unknown; };
  const double one = at(angle.low), other = at(angle.high);
  const bool known = std::isfinite(one) && std::isfinite(other);
  number.low = known ? std::min(one, other) : unknown;
  number.high = known ? std::max(one, other) : unknown;
  return number;
}

}  // namespace

void add_footing(const std::vector<Test>& tests, Sheet& sheet) {
  Readings peaks;
  for (const Test& test : tests) {
    const auto records = last_records(test);
    if (test.purpose != Purpose::drained || records.empty()) continue;
    const calibrate::Peak peak = calibrate::peak(records, test.dimension);
    peaks.push_back({&test, calibrate::friction_angle_deg(peak.stresses), angle_error_deg(test, records[peak.record]),
                     peak.stresses.s()});
  }
  std::vector<Number> angles;
  for (const Readings& part : by_density(peaks)) {
    Number angle = number_of(secant_angle, part, [](const Readings& own) {
      double product = 0, squares = 0;
      for (const Reading& each : own) {
        product += each.at * each.at * std::sin(each.value * std::numbers::pi / 180);
        squares += each.at * each.at;
      }
      return std::asin(product / squares) * 180 / std::numbers::pi;
    });
    angle.density_name = part.front().test->density_name;
    angle.relative_density = part.front().test->relative_density;
    if (add_number(sheet, angle)) angles.push_back(angle);
  }
  if (const Number* const critical = number_in(sheet, "phi_cs_deg")) angles.push_back(*critical);
  for (const Factor& factor : factors)
    for (const Number& angle : angles) add_number(sheet, factor_of(factor, angle));
}

}  // namespace rvelab::sheet
