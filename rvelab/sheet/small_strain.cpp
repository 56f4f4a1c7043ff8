// Shear modulus at small strain by probes, and how it falls, and damping rises, with the strain of cycles.
//
//   G0 = G_ref F(e) (p/p_ref)^n, F(e) = (2.17 - e)^2/(1 + e), p_ref = 100 kPa      Hardin and Richart 1963, Iwasaki and
//                                                                                  Tatsuoka 1977; discs: F = 1
//   G, damping of a loop: rvelab/ensemble/loops.hpp, of the last whole loop of a stage
//   gamma_0.7: strain at which G/G0 = 0.722, so that G/G0 = 1/(1 + 0.385 gamma/gamma_0.7) (Santos and Correia 2001)
// G0 of a cyclic test is that of a probe in it, else the stiffest of what the tests of its specimen at this pressure
// begin with.
//
// Published curves of sands:
//   G/G0 = 1/(1 + ((gamma - gamma_e)/gamma_r)^a), a = 0.88; gamma_r, gamma_e in %: mean 0.044, 0.0007, lower 0.02, 0,
//   upper 0.1, 0.003 (Oztoprak and Bolton 2013, Geotechnique 63(1), 54-70). The form of the curve, and what gamma_e and
//   gamma_r are, stand in their abstract; the values are from memory, no text with them was at hand.
//   Seed and Idriss (1970), EERC 70-10: points as tabulated by the site response program Strata (github.com/arkottke/
//   strata, "Seed & Idriss, Sand Mean"). A second digitisation, of upper and lower curve by F. Gatti
//   (G_gamma_D_model_curves.m), has means within 0.02 of G/G0 and 0.8 % of damping.
#include <algorithm>
#include <cmath>
#include <map>

#include "rvelab/ensemble/loops.hpp"
#include "rvelab/error.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/sheet/groups.hpp"
#include "rvelab/sheet/probed.hpp"

namespace rvelab::sheet {
namespace {

constexpr const char* small_strain_group = "Small strains";
constexpr About probed_modulus{small_strain_group,
                               "G0_Pa",
                               "G\u2080",
                               "Pa",
                               "mean shear stiffness of a probe at isotropic stress",
                               "elastic tangent of the packing"};
constexpr About modulus_at_reference{small_strain_group,
                                     "G0_ref_Pa",
                                     "G\u2080 at 100 kPa",
                                     "Pa",
                                     "of ln G\u2080 in ln p, over the pressures of a density",
                                     "Iwasaki and Tatsuoka 1977"};
constexpr About law_modulus{small_strain_group,
                            "G_ref_Pa",
                            "G_ref of sands",
                            "Pa",
                            "G\u2080 = G_ref F(e) (p/p_ref)\u207f, F = (2.17 \u2212 e)\u00b2/(1 + e) (discs 1), "
                            "p_ref = 100 kPa, over all densities",
                            "Iwasaki and Tatsuoka 1977"};
constexpr About modulus_exponent{small_strain_group,
                                 "G0_exponent",
                                 "exponent n of G\u2080",
                                 "",
                                 "of the same law, over all densities and pressures",
                                 "Iwasaki and Tatsuoka 1977"};
constexpr About modulus_scatter{small_strain_group,
                                "G0_scatter",
                                "scatter around the law of G\u2080",
                                "",
                                "root of the mean square of ln G\u2080 less the law, over single probes",
                                "Iwasaki and Tatsuoka 1977"};
constexpr About threshold{small_strain_group,
                          "gamma_07",
                          "\u03b3_0.7",
                          "",
                          "shear strain at which G/G\u2080 = 0.722, linear in its logarithm between tests",
                          "Santos and Correia 2001"};

double void_ratio_function(double e, int dimension) { return dimension == 2 ? 1 : (2.17 - e) * (2.17 - e) / (1 + e); }

void add_probes(const std::vector<Test>& tests, Sheet& sheet) {
  Readings moduli, normalised;
  std::vector<Test> at_pressures;  // of the probes
  const std::vector<Probed> all = probed_moduli(tests);
  at_pressures.reserve(all.size());
  for (const Probed& probed : all) {
    at_pressures.push_back(at_abscissa(*probed.test, std::isfinite(probed.pressure) ? probed.pressure : probed.p));
    const Test* const test = &at_pressures.back();
    moduli.push_back({test, probed.G, unknown, probed.p});
    normalised.push_back({test, probed.G / void_ratio_function(probed.void_ratio, test->dimension), unknown, probed.p});
  }
  if (moduli.empty()) {
    sheet.remarks.push_back("G0 is left out: no test has a probe at isotropic stress.");
    return;
  }
  for (const Readings& part : by_pressure(moduli)) {
    Number number = number_of(probed_modulus, part);
    number.density_name = part.front().test->density_name;
    number.relative_density = part.front().test->relative_density;
    number.pressure = part.front().test->pressure;
    add_number(sheet, std::move(number));
  }
  const Number reference = number_of(law_modulus, normalised,
                                     [](const Readings& own) { return power_law(own, reference_pressure).intercept; });
  const Number exponent_n = number_of(modulus_exponent, normalised,
                                      [](const Readings& own) { return power_law(own, reference_pressure).slope; });
  if (!add_number(sheet, reference)) {
    sheet.remarks.push_back("The law of G0 is left out: it needs probes at two pressures or more.");
    return;
  }
  add_number(sheet, exponent_n);
  add_by_density(sheet, modulus_at_reference, moduli,
                 [](const Readings& own) { return power_law(own, reference_pressure).intercept; });
  const auto law = [&](double p) { return reference.mean * std::pow(p / reference_pressure, exponent_n.mean); };
  Number scatter = number_of(modulus_scatter, normalised);
  double squares = 0, low = normalised.front().at, high = low;
  for (const Reading& each : normalised) {
    squares += std::pow(std::log(each.value / law(each.at)), 2);
    low = std::min(low, each.at), high = std::max(high, each.at);
  }
  scatter.mean = std::sqrt(squares / double(normalised.size()));
  scatter.standard_error = scatter.low = scatter.high = unknown;
  add_number(sheet, std::move(scatter));
  const bool plane = tests.front().dimension == 2;
  Figure figure{"G0",
                "Shear modulus at small strain",
                "p (kPa)",
                plane ? "G\u2080 (MPa)" : "G\u2080/F(e) (MPa)",
                plane ? "Probes; line: the law fitted to all."
                      : "Probes over F(e) = (2.17 \u2212 e)\u00b2/(1 + e); line: the law fitted to all densities.",
                true,
                true,
                {},
                small_strain_group};
  for (const Readings& part : by_density(normalised))
    figure.series.push_back(mean_series(part, 1e-3, 1e-6, density_label(*part.front().test)));
  figure.series.push_back({"law", {low / 1200, 1.2 * high / 1000}, {}, {}, true, false});
  for (const double p : {low / 1.2, 1.2 * high}) figure.series.back().y.push_back(1e-6 * law(p));
  sheet.figures.push_back(std::move(figure));
}

/// A loop of a cyclic test.
struct Decay {
  const Test* test;
  double gamma, G, damping, G0 = unknown, stress_error;
};

/// Loops of every stage that goes to and fro, the last whole one of each; G0 where the test has a probe.
std::vector<Decay> loops_in(const Test& test) {
  std::vector<Decay> found;
  const auto& records = test.result.records;
  for (std::size_t begin = 0, end = 0; begin < records.size(); begin = end) {
    while (end < records.size() && records[end].stage == records[begin].stage) ++end;
    const std::span<const records::Record> stage(&records[begin], end - begin);
    const auto loops = ensemble::loops_of(stage, test.result.axis, test.dimension);
    if (loops.empty()) continue;
    const ensemble::Loop& last = loops.back();
    const auto reference =
        ensemble::reference_modulus(stage, loops, test.result.probes, test.result.axis, test.dimension);
    found.push_back({&test, last.gamma, last.G, last.damping_ratio, reference.G, stress_error(test, stage.back())});
  }
  return found;
}

/// Loops of one specimen at one pressure, by their strain, with one G0.
using Specimen = std::vector<Decay>;
std::vector<Specimen> specimens_of(const std::vector<Test>& tests) {
  std::map<std::tuple<std::size_t, double, std::uint64_t>, Specimen> found;
  for (const Test& test : tests) {
    if (test.purpose != Purpose::cyclic_strain) continue;
    for (const Decay& loop : loops_in(test)) found[{test.density, test.pressure, test.seed}].push_back(loop);
  }
  std::vector<Specimen> all;
  for (auto& [place, loops] : found) {
    std::sort(loops.begin(), loops.end(), [](const Decay& one, const Decay& other) { return one.gamma < other.gamma; });
    const auto probe =
        std::find_if(loops.begin(), loops.end(), [](const Decay& loop) { return !loop.test->result.probes.empty(); });
    double G0 = probe == loops.end() ? 0 : probe->G0;
    if (probe == loops.end())
      for (const Decay& loop : loops) G0 = std::max(G0, loop.G0);
    for (Decay& loop : loops) loop.G0 = G0;
    all.push_back(std::move(loops));
  }
  return all;
}

/// Strain at which G/G0 passes a part; NaN: it is not within the tests.
double strain_at_part(const Specimen& loops, double part) {
  for (std::size_t k = 1; k < loops.size(); ++k) {
    const double before = loops[k - 1].G / loops[k - 1].G0, after = loops[k].G / loops[k].G0;
    if (before >= part && after < part)
      return loops[k - 1].gamma * std::pow(loops[k].gamma / loops[k - 1].gamma, (before - part) / (before - after));
  }
  return unknown;
}

void add_published_decay(Figure& ratio, Figure& damping) {
  struct Band {
    const char* label;
    double gamma_r, gamma_e;
  };
  constexpr double a = 0.88;
  for (const Band& band :
       {Band{"Oztoprak and Bolton 2013, mean", 0.044, 0.0007}, Band{"Oztoprak and Bolton 2013, lower", 0.02, 0},
        Band{"Oztoprak and Bolton 2013, upper", 0.1, 0.003}}) {
    Series line{band.label, {}, {}, {}, true, true};
    for (int k = 0; k <= 60; ++k) {
      const double percent = 1e-4 * std::pow(10.0, k / 12.0);
      line.x.push_back(percent);
      line.y.push_back(percent <= band.gamma_e ? 1 : 1 / (1 + std::pow((percent - band.gamma_e) / band.gamma_r, a)));
    }
    ratio.series.push_back(std::move(line));
  }
  const std::vector<double> strains{1e-4, 3.16e-4, 1e-3, 3.16e-3, 1e-2, 3.16e-2, 0.1, 0.316, 1};
  ratio.series.push_back(
      {"Seed and Idriss 1970, mean", strains, {1, 0.99, 0.96, 0.88, 0.74, 0.52, 0.29, 0.15, 0.06}, {}, true, true});
  damping.series.push_back(
      {"Seed and Idriss 1970, mean", strains, {0.57, 0.86, 1.7, 3.1, 5.5, 9.5, 15.5, 21.1, 24.6}, {}, true, true});
  damping.series.push_back(
      {"Seed and Idriss 1970, lower", strains, {0.5, 0.6, 0.8, 1.4, 2.8, 5.3, 10, 15.8, 21.5}, {}, true, true});
}

/// `strains`: one reading for each specimen, of its first test.
void add_decay_figures(const std::vector<Specimen>& specimens, const Readings& strains, Sheet& sheet) {
  const char* const strain_axis = "amplitude of the shear strain (%)";
  Figure ratio{"decay",
               "Shear modulus over strain",
               strain_axis,
               "G/G\u2080",
               "Means over specimens with 95 % intervals, beside published curves of sands.",
               true,
               false,
               {},
               small_strain_group};
  Figure damping{"damping",
                 "Damping over strain",
                 strain_axis,
                 "damping ratio (%)",
                 "Hysteretic damping of quasi-static loops, beside published curves of sands.",
                 true,
                 false,
                 {},
                 small_strain_group};
  for (const Readings& part : by_pressure(strains)) {
    std::vector<Test> places;
    std::vector<const Decay*> own;
    for (const Specimen& loops : specimens)
      for (const Decay& loop : loops)
        if (std::any_of(part.begin(), part.end(),
                        [&](const Reading& each) { return each.test == loops.front().test; })) {
          places.push_back(at_abscissa(*loop.test, loop.gamma));
          own.push_back(&loop);
        }
    Readings ratios, dampings;
    for (std::size_t k = 0; k < own.size(); ++k) {
      ratios.push_back({&places[k], own[k]->G / own[k]->G0, unknown, own[k]->gamma});
      dampings.push_back({&places[k], own[k]->damping, unknown, own[k]->gamma});
    }
    const Test& first = *part.front().test;
    const std::string name = density_label(first) + ", " + pressure_label(first.pressure);
    ratio.series.push_back(mean_series(ratios, 100, 1, name));
    damping.series.push_back(mean_series(dampings, 100, 100, name));
  }
  add_published_decay(ratio, damping);
  sheet.figures.push_back(std::move(ratio));
  sheet.figures.push_back(std::move(damping));
}

void add_decay(const std::vector<Test>& tests, Sheet& sheet) {
  const std::vector<Specimen> specimens = specimens_of(tests);
  if (specimens.empty()) {
    sheet.remarks.push_back("G over strain, damping and gamma_0.7 are left out: no test has whole loops of strain.");
    return;
  }
  Readings strains;
  for (const Specimen& loops : specimens) {
    Specimen moved = loops;
    for (Decay& loop : moved) loop.G += loop.stress_error / loop.gamma;
    const double strain = strain_at_part(loops, 0.722);
    strains.push_back({loops.front().test, strain, std::abs(strain_at_part(moved, 0.722) - strain)});
  }
  add_by_density(sheet, threshold, strains);
  if (std::none_of(strains.begin(), strains.end(), [](const Reading& each) { return std::isfinite(each.value); }))
    sheet.remarks.push_back(
        "gamma_0.7 is left out: G/G0 does not pass 0.722 between the smallest and the largest strain.");
  add_decay_figures(specimens, strains, sheet);
}

}  // namespace

void add_small_strain(const std::vector<Test>& tests, Sheet& sheet) {
  add_probes(tests, sheet);
  add_decay(tests, sheet);
}

}  // namespace rvelab::sheet
