// Stiffness of drained compression and of the oedometer, as the Hardening Soil model takes it (Schanz, Vermeer and
// Bonnier 1999): E = E_ref ((c cot phi + sigma_3)/(c cot phi + p_ref))^m with c = 0, p_ref = 100 kPa.
//
//   E50     secant from the start to half of the largest increase of q, over the axial strain
//   E50_ref, m   least squares of ln E50 in ln(sigma_3/p_ref) over the pressures of a density
//   R_f = q_f/q_a   of the hyperbola q = eps/(a + b eps), q_a = 1/b: least squares of eps/q in eps from 70 to 95 % of
//           q_f (Duncan and Chang 1970, who take these two points)
//   E_oed   secant of the first loading between 0.64 and 1.44 p_ref: the tangent at p_ref where E goes as sqrt(sigma)
//   K0nc = sigma_h/sigma_v at the end of the first loading
//   nu_ur = r/(1 + r), r = change of sigma_h over that of sigma_v    oedometer, unloading to half of the largest
//   E_ur = E_u (1 + nu)(1 - 2 nu)/(1 - nu)                           sigma_v, E_u its secant; brought to p_ref by m and
//                                                                    the mean of the smaller stress at both ends
// Discs have no third direction: nu_ur = r, E_ur = E_u (1 - nu^2).
#include <algorithm>
#include <cmath>

#include "rvelab/ensemble/features.hpp"
#include "rvelab/ensemble/measures.hpp"
#include "rvelab/sheet/groups.hpp"

namespace rvelab::sheet {
namespace {

constexpr const char* stiffness_group = "Stiffness";
constexpr const char* hardening_soil = "Schanz, Vermeer and Bonnier 1999";
constexpr About secant{stiffness_group,
                       "E50_Pa",
                       "E\u2085\u2080",
                       "Pa",
                       "secant of q over the axial strain, from the start to half of the largest q",
                       hardening_soil};
constexpr About secant_reference{stiffness_group,
                                 "E50_ref_Pa",
                                 "E\u2085\u2080 at 100 kPa",
                                 "Pa",
                                 "E\u2085\u2080 = E\u2085\u2080,ref (\u03c3\u2083/p_ref)^m, c = 0, p_ref = 100 kPa",
                                 hardening_soil};
constexpr About exponent{
    stiffness_group, "exponent_m", "exponent m", "", "of E\u2085\u2080 in \u03c3\u2083, over the pressures",
    hardening_soil};
constexpr About failure_ratio{
    stiffness_group,        "R_f", "failure ratio R_f", "", "q_f/q_a, q_a of the hyperbola from 70 to 95 % of q_f",
    "Duncan and Chang 1970"};
constexpr About oedometric{stiffness_group,
                           "Eoed_ref_Pa",
                           "E_oed at 100 kPa",
                           "Pa",
                           "secant of the first loading of the oedometer between 64 and 144 kPa",
                           hardening_soil};
constexpr About unloading{stiffness_group,
                          "Eur_ref_Pa",
                          "E_ur at 100 kPa",
                          "Pa",
                          "oedometer, unloading to half of the largest stress, by \u03bd_ur; to 100 kPa by m",
                          hardening_soil};
constexpr About unloading_ratio{stiffness_group,
                                "nu_ur",
                                "\u03bd_ur",
                                "",
                                "r/(1 + r) (discs r), r = \u0394\u03c3_h/\u0394\u03c3_v of the same unloading",
                                "elasticity"};
constexpr About at_rest{
    stiffness_group, "K0nc", "K\u2080 of first loading", "", "\u03c3_h/\u03c3_v of the oedometer at its largest stress",
    "Jaky 1944"};

std::vector<double> deviators(const Test& test, std::span<const records::Record> records) {
  std::vector<double> q;
  for (const records::Record& record : records) q.push_back(axial_stress(test, record) - lateral_stress(test, record));
  for (std::size_t k = q.size(); k-- > 0;) q[k] -= q.front();
  return q;
}

/// Slope of eps/q over eps from the first record at 70 % of the largest q to the first at 95 %, times this q.
double failure_ratio_of(const Test& test) {
  const auto records = last_records(test);
  const std::vector<double> q = deviators(test, records);
  const double largest = *std::max_element(q.begin(), q.end());
  std::vector<double> strains, compliances;
  for (std::size_t k = 1; k < q.size(); ++k) {
    const double strain = records[k].strain - records.front().strain;
    if ((strains.empty() && q[k] < 0.7 * largest) || !(q[k] > 0)) continue;
    strains.push_back(strain);
    compliances.push_back(strain / q[k]);
    if (q[k] >= 0.95 * largest) break;
  }
  const double ratio = straight_through(strains, compliances).slope * largest;
  return ratio > 0 && ratio <= 1 ? ratio : unknown;
}

void add_compression(const std::vector<Test>& tests, Sheet& sheet) {
  Readings moduli, ratios;
  for (const TestGroup& own : groups_of(tests, Purpose::drained)) {
    for (const Test* test : own.tests) {
      const auto records = last_records(*test);
      const std::vector<double> q = deviators(*test, records);
      const double half = 0.5 * *std::max_element(q.begin(), q.end());
      const auto at = std::find_if(q.begin(), q.end(), [&](double value) { return value >= half; }) - q.begin();
      const double modulus = measure_of(*test, "E50_Pa");
      moduli.push_back({test, modulus, modulus * stress_error(*test, records[std::size_t(at)]) / half, test->pressure});
      ratios.push_back({test, failure_ratio_of(*test)});
    }
  }
  if (moduli.empty()) {
    sheet.remarks.push_back("E50, m and R_f are left out: there is no drained test.");
    return;
  }
  add_by_pressure(sheet, secant, moduli);
  add_by_density(sheet, failure_ratio, ratios);
  const auto without =
      std::count_if(ratios.begin(), ratios.end(), [](const Reading& each) { return std::isnan(each.value); });
  if (without > 0)
    sheet.remarks.push_back(std::to_string(without) + " of " + std::to_string(ratios.size()) +
                            " drained tests are no hyperbola from 70 to 95 % of q: R_f is that of the others.");
  const auto fitted = [&](const About& about, double Straight::*part) {
    add_by_density(sheet, about, moduli,
                   [part](const Readings& own) { return power_law(own, reference_pressure).*part; });
  };
  const std::size_t before = sheet.numbers.size();
  fitted(secant_reference, &Straight::intercept);
  fitted(exponent, &Straight::slope);
  if (sheet.numbers.size() == before) {
    Readings there;
    for (const Reading& each : moduli)
      if (std::abs(each.at - reference_pressure) < 0.02 * reference_pressure) there.push_back(each);
    add_by_density(sheet, secant_reference, there);
    sheet.remarks.push_back(there.empty() ? "E50 at 100 kPa and m are left out: drained tests at two pressures or more "
                                            "give them."
                                          : "m is left out: drained tests at two pressures or more give it.");
  }
  Figure figure{"E50",
                "Stiffness over pressure",
                "\u03c3\u2083 (kPa)",
                "E\u2085\u2080 (MPa)",
                "Means over specimens with 95 % intervals; lines: the power law of each density.",
                true,
                true,
                {},
                stiffness_group};
  for (const Readings& part : by_density(moduli)) {
    const std::string name = density_label(*part.front().test);
    figure.series.push_back(mean_series(part, 1e-3, 1e-6, name));
    const Straight law = power_law(part, reference_pressure);
    if (!std::isfinite(law.slope)) continue;
    Series line{name, {}, {}, {}, true, false};
    const auto [low, high] =
        std::minmax_element(part.begin(), part.end(), [](const Reading& a, const Reading& b) { return a.at < b.at; });
    for (const double p : {low->at / 1.2, high->at * 1.2}) {
      line.x.push_back(p / 1000);
      line.y.push_back(1e-6 * law.intercept * std::pow(p / reference_pressure, law.slope));
    }
    figure.series.push_back(std::move(line));
  }
  sheet.figures.push_back(std::move(figure));
}

/// Strain of a branch of an oedometer test where its stress passes a value; `error`: of the strain, that of the stress
/// there brings. NaN: it does not.
double strain_of(const std::vector<double>& stress, const std::vector<double>& strain, double at) {
  for (std::size_t k = 1; k < stress.size(); ++k)
    if ((stress[k - 1] - at) * (stress[k] - at) <= 0 && stress[k] != stress[k - 1])
      return std::lerp(strain[k - 1], strain[k], std::log(at / stress[k - 1]) / std::log(stress[k] / stress[k - 1]));
  return unknown;
}

struct Oedometer {
  double loading = unknown, loading_error = unknown;      ///< E_oed at p_ref
  double at_rest = unknown, at_rest_error = unknown;      ///< K0
  double ratio = unknown, ratio_error = unknown;          ///< nu_ur
  double unloading = unknown, unloading_error = unknown;  ///< E_ur
  double minor = unknown;                                 ///< mean smaller stress of the unloading
};

Oedometer oedometer_of(const Test& test) {
  Oedometer found;
  const auto& all = test.result.records;
  const auto path = ensemble::path_of(test.result, test.dimension, true, 1);
  const auto peak = std::max_element(all.begin(), all.end(), [&](const auto& one, const auto& other) {
    return axial_stress(test, one) < axial_stress(test, other);
  });
  const double largest = axial_stress(test, *peak), lateral = lateral_stress(test, *peak);
  const double error = stress_error(test, *peak);
  found.at_rest = lateral / largest;
  found.at_rest_error = error / largest * (1 + found.at_rest);
  const double from = 0.64 * reference_pressure, to = 1.44 * reference_pressure;
  const double loading_strain =
      strain_of(path.loading, path.loading_strain, to) - strain_of(path.loading, path.loading_strain, from);
  found.loading = (to - from) / loading_strain;
  found.loading_error = found.loading * error / largest * (to + from) / (to - from);
  // Unloading to half of the largest stress: the first record there, and the one before.
  const auto half = std::find_if(peak, all.end(), [&](const records::Record& record) {
    return axial_stress(test, record) <= 0.5 * largest * (1 + 1e-3);
  });
  if (half == peak || half == all.end()) return found;
  const double axial = axial_stress(test, *half), side = lateral_stress(test, *half);
  const double r = (lateral - side) / (largest - axial);
  const double span = largest - axial;
  const double r_error = (error + stress_error(test, *half)) * (1 + r) / span;
  const bool plane = test.dimension == 2;
  found.ratio = plane ? r : r / (1 + r);
  found.ratio_error = plane ? r_error : r_error / ((1 + r) * (1 + r));
  if (path.unloading.size() < 2) return found;
  const auto at = std::size_t(std::find_if(path.unloading.begin(), path.unloading.end(),
                                           [&](double stress) { return stress <= axial * (1 + 1e-6); }) -
                              path.unloading.begin());
  if (at == path.unloading.size()) return found;
  const double nu = found.ratio, secant_modulus = span / (path.unloading_strain.front() - path.unloading_strain[at]);
  found.unloading = secant_modulus * (plane ? 1 - nu * nu : (1 + nu) * (1 - 2 * nu) / (1 - nu));
  found.unloading_error = found.unloading * (error + stress_error(test, *half)) / span;
  found.minor = 0.5 * (std::min(largest, lateral) + std::min(axial, side));
  return found;
}

void add_oedometer(const std::vector<Test>& tests, Sheet& sheet) {
  Readings loading, rest, ratio, unloaded;
  for (const TestGroup& own : groups_of(tests, Purpose::oedometer)) {
    for (const Test* test : own.tests) {
      const Oedometer found = oedometer_of(*test);
      loading.push_back({test, found.loading, found.loading_error});
      rest.push_back({test, found.at_rest, found.at_rest_error});
      ratio.push_back({test, found.ratio, found.ratio_error});
      const auto m = std::find_if(sheet.numbers.begin(), sheet.numbers.end(), [&](const Number& number) {
        return number.key == "exponent_m" && number.density_name == test->density_name;
      });
      if (m == sheet.numbers.end()) continue;
      const double factor = std::pow(reference_pressure / found.minor, m->mean);
      unloaded.push_back({test, factor * found.unloading, factor * found.unloading_error});
    }
  }
  if (rest.empty()) {
    sheet.remarks.push_back("E_oed, E_ur, nu_ur and K0 are left out: there is no oedometer test.");
    return;
  }
  const auto has_value = [](const Readings& readings) {
    return std::any_of(readings.begin(), readings.end(), [](const Reading& each) { return std::isfinite(each.value); });
  };
  add_by_density(sheet, oedometric, loading);
  add_by_density(sheet, unloading, unloaded);
  add_by_density(sheet, unloading_ratio, ratio);
  add_by_density(sheet, at_rest, rest);
  if (!has_value(loading))
    sheet.remarks.push_back("E_oed at 100 kPa is left out: no oedometer test loads from 64 kPa to 144 kPa.");
  if (!has_value(ratio))
    sheet.remarks.push_back("E_ur and nu_ur are left out: no oedometer test unloads to half of its largest stress.");
  else if (!has_value(unloaded))
    sheet.remarks.push_back("E_ur at 100 kPa is left out: m, which brings it there, is not known.");
}

}  // namespace

void add_stiffness(const std::vector<Test>& tests, Sheet& sheet) {
  add_compression(tests, sheet);
  add_oedometer(tests, sheet);
}

}  // namespace rvelab::sheet
