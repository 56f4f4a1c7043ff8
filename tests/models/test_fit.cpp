#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/models/element_tests.hpp"
#include "tests/refusal.hpp"
#include "tools/models/hardening_soil_small.hpp"
#include "tools/models/hypoplasticity.hpp"
#include "tools/models/models.hpp"
#include "tools/models/mohr_coulomb.hpp"
#include "tools/models/norsand.hpp"

using namespace rvelab::models;
using namespace rvelab::test;

namespace {

/// Fitted parameters are the true ones within 2 %, and tests that were kept back are predicted.
void check_round_trip(const std::string& model, const std::vector<ElementTest>& tests,
                      const std::map<std::string, double>& numbers, const std::vector<double>& truth) {
  const Fit found = fit(model, tests, numbers);
  REQUIRE(found.parameters.size() == truth.size());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    CAPTURE(found.parameters[k].name, found.parameters[k].low, found.parameters[k].high);
    CHECK(found.parameters[k].value == Approx(truth[k]).epsilon(0.02));
  }
  REQUIRE(found.misfits.size() == tests.size());
  std::size_t predicted = 0;
  for (std::size_t k = 0; k < tests.size(); ++k) {
    const Misfit& misfit = found.misfits[k];
    CAPTURE(misfit.test, misfit.remark);
    CHECK(misfit.test == tests[k].name);
    if (tests[k].loading == Loading::cyclic_shear && model != "hardening_soil_small") continue;
    if (!misfit.fitted) ++predicted;
    if (tests[k].loading != Loading::isotropic) CHECK(misfit.stress < 0.01);
    if (std::isfinite(misfit.strain)) CHECK(misfit.strain < 2e-4);
  }
  CHECK(predicted > 0);
}

std::vector<ElementTest> own_curves(const Law& law, double loose, double dense) {
  return {by(law, sheared("drained 100", Loading::drained, 1e5, dense, 0.12)),
          by(law, sheared("drained 200", Loading::drained, 2e5, loose, 0.15)),
          by(law, sheared("drained 50", Loading::drained, 5e4, 0.5 * (loose + dense), 0.12)),
          by(law, sheared("undrained 100", Loading::undrained, 1e5, 0.5 * (loose + dense), 0.03)),
          by(law, compressed("oedometer", Loading::oedometer, 5e4, dense, {8e5, 1e5, 4e5})),
          by(law, compressed("loose oedometer", Loading::oedometer, 2e4, loose, {8e5})),
          by(law, compressed("isotropic", Loading::isotropic, 5e4, loose, {8e5})),
          by(law, sheared("drained 400, kept back", Loading::drained, 4e5, dense, 0.12), false),
          by(law, sheared("undrained 200, kept back", Loading::undrained, 2e5, dense, 0.02), false)};
}

const Parameter& parameter(const Fit& fit, const std::string& name) {
  for (const Parameter& one : fit.parameters)
    if (one.name == name) return one;
  throw std::runtime_error("no parameter " + name);
}

std::vector<ElementTest> specimen(const std::string& density) {
  static const std::map<std::string, Loading> loadings{{"drained", Loading::drained},
                                                       {"undrained", Loading::undrained},
                                                       {"oedometer", Loading::oedometer},
                                                       {"cyclic_shear", Loading::cyclic_shear}};
  std::vector<ElementTest> tests;
  for (const auto& row : kept("toyoura_specimen.csv")) {
    if (row.at("test").find(density) == std::string::npos) continue;
    if (tests.empty() || tests.back().name != row.at("test")) {
      ElementTest& test = tests.emplace_back();
      test.name = row.at("test"), test.loading = loadings.at(row.at("loading"));
      test.fitted = row.at("fitted") == "1";
      test.p0 = std::stod(row.at("p0")), test.e0 = std::stod(row.at("e0"));
    }
    tests.back().strain.push_back(std::stod(row.at("strain")));
    tests.back().q.push_back(std::stod(row.at("q")));
    tests.back().p.push_back(std::stod(row.at("p")));
    tests.back().eps_v.push_back(std::stod(row.at("eps_v")));
  }
  return tests;
}

}  // namespace

TEST_CASE("a fit of Mohr-Coulomb finds what its own curves were made with") {
  auto tests = own_curves(MohrCoulomb(36, 6, 6e7, 0.28), 0.6, 0.6);
  tests.erase(tests.begin() + 6);  // elastic without limit
  check_round_trip("mohr_coulomb", tests, {}, {36, 6, 6e7, 0.28});
}

TEST_CASE("a fit of Hardening Soil small finds what its own curves were made with") {
  const HardeningSoilSmall law({38, 8, 3e7, 2.8e7, 9e7, 0.55, 0.2, 0.42, 0.88, 1.1e8, 2e-4});
  auto tests = own_curves(law, 0.6, 0.6);
  ElementTest shear;
  shear.name = "shear", shear.loading = Loading::cyclic_shear, shear.p0 = 1e5, shear.e0 = 0.6;
  for (int k = 0; k <= 20; ++k) add_row(shear, 1e-6 * std::pow(10, 0.15 * k), 1e5);
  tests.push_back(by(law, shear));
  check_round_trip("hardening_soil_small", tests, {{"K0nc", 0.42}},
                   {38, 8, 3e7, 2.8e7, 9e7, 0.55, 0.2, 0.42, 0.88, 1.1e8, 2e-4});
}

TEST_CASE("a fit of NorSand finds what its own curves were made with") {
  const NorSandParameters truth{0.9, 0.03, 1.25, 0.35, 4, 150, 400, 0.2, 0.5};
  check_round_trip("norsand", own_curves(NorSand(truth), 0.76, 0.66), {{"G0_exponent", 0.5}},
                   {0.9, 0.03, 1.25, 0.35, 4, 150, 400, 0.2, 0.5});
}

TEST_CASE("a fit of hypoplasticity finds what its own curves were made with") {
  const HypoplasticityParameters truth{33, 1e9, 0.25, 0.55, 0.95, 1.05, 0.25, 1.5};
  check_round_trip("hypoplasticity", own_curves(Hypoplasticity(truth), 0.84, 0.66), {{"e_i0", 1.05}},
                   {33, 1e9, 0.25, 0.55, 0.95, 1.05, 0.25, 1.5});
}

TEST_CASE("what the sheet measured is taken as it is, and has no interval") {
  const NorSandParameters truth{0.9, 0.03, 1.25, 0.35, 4, 150, 400, 0.2};
  const auto tests = own_curves(NorSand(truth), 0.76, 0.66);
  const double phi_cs = std::asin(3 * 1.25 / (6 + 1.25)) / 0.017453292519943295;
  const Fit found =
      fit("norsand", tests, {{"critical_line_Gamma", 0.9}, {"critical_line_lambda_ln", 0.03}, {"phi_cs_deg", phi_cs}});
  for (const char* name : {"Gamma", "lambda", "M_tc"}) {
    CAPTURE(name);
    CHECK(std::isnan(parameter(found, name).low));
    CHECK(std::isnan(parameter(found, name).high));
  }
  CHECK(parameter(found, "M_tc").value == Approx(1.25));
  CHECK(parameter(found, "H").value == Approx(150).epsilon(0.02));
  CHECK(parameter(found, "H").low <= parameter(found, "H").value);
  CHECK(parameter(found, "H").high >= parameter(found, "H").value);
}

TEST_CASE("a number of the sheet that the model cannot take is fitted, and one that the others change is told") {
  const auto says = [](const Fit& fit, const std::string& words) {
    return std::any_of(fit.remarks.begin(), fit.remarks.end(),
                       [&](const std::string& each) { return each.find(words) != std::string::npos; });
  };
  const NorSandParameters truth{0.9, 0.03, 1.25, 0.35, 4, 150, 400, 0.2};
  const Fit rising = fit("norsand", own_curves(NorSand(truth), 0.76, 0.66),
                         {{"critical_line_Gamma", 0.9}, {"critical_line_lambda_ln", -0.01}});
  CHECK(says(rising, "lambda of the sheet, -0.01, is not among what the model takes, 0.0001 to 0.3: it is fitted"));
  CHECK(parameter(rising, "lambda").value == Approx(0.03).epsilon(0.02));
  CHECK(std::isfinite(parameter(rising, "lambda").low));
  CHECK(std::isnan(parameter(rising, "Gamma").low));

  const HardeningSoilSmall law({38, 8, 3e7, 2.8e7, 9e7, 0.55, 0.2, 0.42, 0.88, 1.1e8, 2e-4});
  const Fit soft =
      fit("hardening_soil_small", own_curves(law, 0.6, 0.6), {{"K0nc", 0.42}, {"Eur_ref_Pa", 9e7}, {"G0_ref_Pa", 2e7}});
  // G_ur = E_ur/(2 (1 + nu)).
  CHECK(parameter(soft, "G0_ref").value == Approx(9e7 / 2.4));
  CHECK(std::string(name_of(parameter(soft, "G0_ref").origin)) == "sheet (changed)");
  CHECK(parameter(soft, "Eur_ref").origin == Origin::sheet);
  CHECK(says(soft, "G0_ref of the sheet, 2e+07 Pa, does not go with the other parameters: 3.75e+07 Pa is used"));
}

TEST_CASE("what is assumed is told from what is fitted and what the sheet gives, in the table too") {
  const HardeningSoilSmall law({38, 8, 3e7, 2.8e7, 9e7, 0.55, 0.2, 0.42, 0.88, 1.1e8, 2e-4});
  const Fit found = fit("hardening_soil_small", own_curves(law, 0.6, 0.6), {{"K0nc", 0.42}, {"Eur_ref_Pa", 9e7}});
  const std::map<std::string, Origin> origins{
      {"phi", Origin::fitted},    {"E50_ref", Origin::fitted}, {"Eur_ref", Origin::sheet},   {"K0nc", Origin::sheet},
      {"nu_ur", Origin::assumed}, {"G0_ref", Origin::assumed}, {"gamma_07", Origin::assumed}};
  for (const auto& [name, origin] : origins) {
    CAPTURE(name);
    CHECK(parameter(found, name).origin == origin);
    CHECK(std::isnan(parameter(found, name).low) == (origin != Origin::fitted));
  }
  // G0 follows an E_ur that the fit moves away from its guess of 3 E50.
  const Fit follows = fit("hardening_soil_small", own_curves(law, 0.6, 0.6), {{"E50_ref_Pa", 5e7}});
  CHECK(parameter(follows, "G0_ref").origin == Origin::assumed);
  CHECK(parameter(follows, "Eur_ref").value < 0.95 * 3 * 5e7);
  CHECK(parameter(follows, "G0_ref").value == Approx(0.8 * parameter(follows, "Eur_ref").value));
  const std::string told = "assumed, since neither tests nor sheet tell: nu_ur, G0_ref, gamma_07";
  CHECK(std::find(found.remarks.begin(), found.remarks.end(), told) != found.remarks.end());
  const std::string table = card(found, "table");
  CHECK(table.find("# " + told + "\n") != std::string::npos);
  CHECK(table.find("gamma0.7, , 0.0001, , , assumed, ") != std::string::npos);
  CHECK(table.find("K0nc, , 0.42, , , sheet, ") != std::string::npos);
}

TEST_CASE("intervals are as wide as the curves scatter, and hold the truth") {
  // Curves off by 3 %, each as a whole, up and down in turn.
  auto tests = own_curves(MohrCoulomb(36, 6, 6e7, 0.28), 0.6, 0.6);
  tests.erase(tests.begin() + 5, tests.begin() + 7);
  const auto half_width = [&](double off) {
    auto scattered = tests;
    double way = 1;
    for (ElementTest& test : scattered) {
      for (double& q : test.q) q *= 1 + way * off;
      way = -way;
    }
    const Fit found = fit("mohr_coulomb", scattered, {});
    CHECK(parameter(found, "phi").low < 36);
    CHECK(parameter(found, "phi").high > 36);
    return parameter(found, "phi").high - parameter(found, "phi").low;
  };
  const double three = half_width(0.03), six = half_width(0.06);
  CHECK(three > 0.3);
  CHECK(six == Approx(2 * three).epsilon(0.3));
}

TEST_CASE("a misspelt model is told by the nearest one") {
  CHECK(input_error([] { fit("nor_sand", {}, {}); }) ==
        "model is 'nor_sand'; the nearest is norsand; choose one of mohr_coulomb, hardening_soil_small, norsand, "
        "hypoplasticity");
}

TEST_CASE("tests that do not suffice are told by those that are missing") {
  const NorSand law({0.9, 0.03, 1.25, 0.35, 4, 150, 400, 0.2});
  std::vector<ElementTest> one{by(law, sheared("d", Loading::drained, 1e5, 0.7, 0.1))};
  CHECK(
      input_error([&] { fit("hardening_soil_small", one, {}); }) ==
      "Hardening Soil small needs drained tests at two pressures at least; to be fitted are 1 drained, 0 undrained, 0 "
      "oedometer, 0 isotropic and 0 cyclic shear tests");
  CHECK(input_error([&] { fit("norsand", one, {}); }).starts_with("NorSand needs three drained or undrained tests"));
  CHECK(
      input_error([&] { fit("mohr_coulomb", {}, {}); }).starts_with("Mohr-Coulomb needs a drained or undrained test"));
  std::vector<ElementTest> three(3, one[0]);
  CHECK(input_error([&] { fit("hypoplasticity", three, {}); }).find("needs an oedometer or isotropic") !=
        std::string::npos);
  one[0].fitted = false;
  CHECK(input_error([&] { fit("mohr_coulomb", one, {}); }).find("to be fitted are 0 drained") != std::string::npos);
  one[0].fitted = true;
  one[0].q.pop_back();
  CHECK(input_error([&] { fit("mohr_coulomb", one, {}); }).find("must have the same number") != std::string::npos);
}

TEST_CASE("rows that are not finite are left out and told") {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  auto tests = own_curves(MohrCoulomb(36, 6, 6e7, 0.28), 0.6, 0.6);
  tests.erase(tests.begin() + 5, tests.begin() + 7);
  tests[0].q[3] = tests[0].eps_v[7] = none;
  for (double& p : tests[1].p) p = none;
  const Fit found = fit("mohr_coulomb", tests, {});
  CHECK(parameter(found, "phi").value == Approx(36).epsilon(0.02));
  CHECK(found.calculated[0].q.size() == tests[0].q.size() - 2);
  REQUIRE(found.remarks.size() >= 2);
  CHECK(found.remarks[0] == "2 rows that are not finite are left out (drained 100)");
  CHECK(found.remarks[1] == "the test is left out: 0 finite rows, 5 are needed (drained 200)");
  CHECK(found.misfits[1].remark == "fewer than 5 rows are finite");
  CHECK(std::isnan(found.misfits[1].stress));
}

TEST_CASE("a strength that no test reached, and several densities, are told") {
  const Hypoplasticity law({33, 1e9, 0.25, 0.55, 0.95, 1.05, 0.25, 1.5});
  const Fit found = fit("mohr_coulomb",
                        {by(law, sheared("loose", Loading::drained, 1e5, 0.85, 0.05)),
                         by(law, sheared("dense", Loading::drained, 1e5, 0.65, 0.2))},
                        {});
  const auto told = [&](const std::string& begin) {
    return std::any_of(found.remarks.begin(), found.remarks.end(),
                       [&](const std::string& remark) { return remark.starts_with(begin); });
  };
  CHECK(told("q of loose still rises at its end: the friction angle is a lower bound"));
  CHECK(!told("q of dense"));
  CHECK(told("void ratios of the tests run from 0.65 to 0.85"));
}

TEST_CASE("a test that the model cannot follow is held from there, with the reason") {
  // Mohr-Coulomb has no small strain, and contracts without end where psi < 0.
  const NorSand law({0.9, 0.03, 1.25, 0.35, 4, 30, 400, 0.2});
  auto tests = own_curves(law, 0.76, 0.66);
  ElementTest shear = sheared("shear", Loading::cyclic_shear, 1e5, 0.7, 1e-3);
  for (double& tau : shear.q) tau = 1e3;
  tests.push_back(shear);
  const Fit found = fit("mohr_coulomb", tests, {});
  CHECK(found.misfits.back().remark == "the model is not calculated in cyclic shear");
  CHECK(std::isnan(found.misfits.back().stress));
  const auto stopped = calculate(MohrCoulomb(30, -10, 5e7, 0.25), sheared("u", Loading::undrained, 1e5, 1.0, 0.1));
  CHECK(stopped.remark.ends_with(": p falls to zero"));
  CHECK(stopped.test.q.back() == stopped.test.q[stopped.test.q.size() - 2]);
}

TEST_CASE("cards have the keywords of their hosts, and tables kPa") {
  auto tests = own_curves(MohrCoulomb(36, 6, 6e7, 0.28), 0.6, 0.6);
  tests.erase(tests.begin() + 5, tests.begin() + 7);
  Fit found = fit("mohr_coulomb", tests, {});
  for (Parameter& one : found.parameters) one.value = one.name == "phi" ? 36 : one.name == "psi" ? 6 : one.value;
  for (Parameter& one : found.parameters) one.value = one.name == "E" ? 6e7 : one.name == "nu" ? 0.28 : one.value;
  const std::string abaqus = card(found, "abaqus"), calculix = card(found, "calculix");
  CHECK(abaqus.find("*ELASTIC\n6e+07, 0.28\n*MOHR COULOMB\n36., 6.\n*MOHR COULOMB HARDENING\n100., 0.\n") !=
        std::string::npos);
  CHECK(calculix.find("*MOHR COULOMB HARDENING\n100., 0.\n100., 1.\n") != std::string::npos);
  CHECK(card(found, "table").find("E, kPa, 60000, ") != std::string::npos);
  found.model = "NorSand";
  CHECK(card(found, "abaqus").empty());
  CHECK(card(found, "calculix").empty());
  CHECK(input_error([&] { card(found, "plaxis"); }) == "host is 'plaxis'; choose one of abaqus, calculix, table");
}

TEST_CASE(
    "NorSand fitted to Karlsruhe fine sand has its critical friction angle and predicts tests at another pressure") {
  auto tests = karlsruhe_drained();
  REQUIRE(tests.size() == 25);
  for (ElementTest& test : tests) test.fitted = std::abs(test.p0 - 200e3) > 20e3;
  const Fit found = fit("norsand", tests, {});
  const double M = parameter(found, "M_tc").value;
  CHECK(std::asin(3 * M / (6 + M)) / 0.017453292519943295 == Approx(33.1).margin(1));  // Wichtmann et al. 2019
  std::size_t kept_back = 0;
  for (const Misfit& misfit : found.misfits) {
    CAPTURE(misfit.test);
    if (misfit.fitted) continue;
    ++kept_back;
    CHECK(misfit.stress < 0.09);
    CHECK(misfit.strain < 0.01);
  }
  CHECK(kept_back == 5);
}

TEST_CASE("misfits on tests of specimens that were kept back stay what they were") {
  // Three specimens each of 250 grains of the recipe toyoura: the bounds are a tenth above what was found, to be
  // noticed when a model gets worse. NorSand, with the exponent of G0 of the recipe, and hypoplasticity are fitted to
  // both densities at once.
  struct Case {
    std::string model, density, test;
    double stress;
  };
  const std::vector<Case> cases{{"mohr_coulomb", "dense", "drained_dense_400kPa", 0.157},
                                {"mohr_coulomb", "dense", "undrained_dense_200kPa", 0.118},
                                {"mohr_coulomb", "loose", "drained_loose_400kPa", 0.113},
                                {"mohr_coulomb", "loose", "undrained_loose_200kPa", 0.152},
                                {"hardening_soil_small", "dense", "drained_dense_400kPa", 0.142},
                                {"hardening_soil_small", "dense", "undrained_dense_200kPa", 0.02},
                                {"hardening_soil_small", "loose", "drained_loose_400kPa", 0.093},
                                {"hardening_soil_small", "loose", "undrained_loose_200kPa", 0.099},
                                {"norsand", "_", "drained_dense_400kPa", 0.1},
                                {"norsand", "_", "drained_loose_400kPa", 0.066},
                                {"norsand", "_", "undrained_loose_200kPa", 0.05},
                                {"hypoplasticity", "_", "drained_dense_400kPa", 0.193},
                                {"hypoplasticity", "_", "drained_loose_400kPa", 0.124},
                                {"norsand", "_", "undrained_dense_200kPa", 0.079},
                                {"hypoplasticity", "_", "undrained_dense_200kPa", 0.041},
                                {"hypoplasticity", "_", "undrained_loose_200kPa", 0.093}};
  std::map<std::string, Fit> fits;
  for (const Case& one : cases) {
    const std::string key = one.model + one.density;
    if (!fits.contains(key)) fits[key] = fit(one.model, specimen(one.density), {{"G0_exponent", 0.364}});
    CAPTURE(one.model, one.test);
    bool found = false;
    for (const Misfit& misfit : fits[key].misfits) {
      if (misfit.test != one.test) continue;
      found = true;
      CHECK(!misfit.fitted);
      CHECK(misfit.remark.empty());
      CHECK(misfit.stress < one.stress);
    }
    CHECK(found);
  }
  // Without that exponent it is 1, and the stiffness grows with p without end.
  for (const Misfit& misfit : fit("norsand", specimen("_"), {}).misfits)
    if (misfit.test == "undrained_dense_200kPa") CHECK(misfit.stress == Approx(1.6).epsilon(0.05));
}
