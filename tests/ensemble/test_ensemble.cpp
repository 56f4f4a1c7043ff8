// Statistics of specimens and measures of tests, against tables, identities and tests made by hand.
#include <cmath>
#include <numbers>

#include "rvelab/ensemble/summary.hpp"
#include "tests/catch.hpp"
#include "tests/ensemble/made_records.hpp"

using namespace rvelab;

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = std::numbers::pi / 180;

records::Record record_of(int stage, double axial, double lateral, double sigma_1, double sigma_3) {
  records::Record record = test::biaxial_record(axial, lateral, sigma_1, sigma_3);
  record.stage = stage;
  return record;
}

protocol::Protocol protocol_of(const std::string& stages) {
  return protocol::parse_protocol("[test]\nname = \"t\"\ndimension = 2\npressure_Pa = 1e4\n" + stages, "t.toml");
}

}  // namespace

TEST_CASE("Student's t is that of the tables") {
  // Two-sided 95 %: Fisher and Yates (1963), table III.
  CHECK(ensemble::students_t(1) == Approx(12.706).epsilon(1e-4));
  CHECK(ensemble::students_t(2) == Approx(4.3027).epsilon(1e-4));
  CHECK(ensemble::students_t(4) == Approx(2.7764).epsilon(1e-4));
  CHECK(ensemble::students_t(9) == Approx(2.2622).epsilon(1e-4));
  CHECK(ensemble::students_t(29) == Approx(2.0452).epsilon(1e-4));
  CHECK(ensemble::students_t(1000) == Approx(1.9623).epsilon(1e-4));
}

TEST_CASE("Mean, deviation, standard error and interval are of the values that are defined") {
  const ensemble::Spread spread = ensemble::spread_of({1, undefined, 2, 3, 4, 5});
  CHECK(spread.n == 5);
  CHECK(spread.mean == 3);
  CHECK(spread.standard_deviation == Approx(std::sqrt(2.5)));
  CHECK(spread.standard_error == Approx(std::sqrt(0.5)));
  CHECK(spread.high - spread.mean == Approx(2.7764 * std::sqrt(0.5)).epsilon(1e-4));
  CHECK(spread.mean - spread.low == Approx(spread.high - spread.mean));
  CHECK(std::isnan(ensemble::spread_of({7}).standard_error));
  CHECK(std::isnan(ensemble::spread_of({undefined}).mean));
  CHECK(ensemble::spread_of({}).n == 0);
}

TEST_CASE("The difference of two groups has the standard error and the degrees of freedom of Welch") {
  const auto found =
      ensemble::difference_of(ensemble::spread_of({1, 2, 3, 4, 5}), ensemble::spread_of({2, 4, 6, 8, 10}));
  CHECK(found.value == -3);
  CHECK(found.standard_error == Approx(std::sqrt(2.5 / 5 + 10.0 / 5)));
  // 2.5^2/(0.5^2/4 + 2^2/4) = 5.882 degrees of freedom.
  CHECK(found.high - found.value == Approx(ensemble::students_t(6.25 / 1.0625) * found.standard_error));
  CHECK(std::isnan(ensemble::difference_of(ensemble::spread_of({1}), ensemble::spread_of({2, 3})).low));
}

TEST_CASE("A value is written to the second digit of its error") {
  CHECK(ensemble::with_error(30.1234, 0.4512) == "30.12 +- 0.45");
  CHECK(ensemble::with_error(30.1234, 4.512) == "30.1 +- 4.5");
  CHECK(ensemble::with_error(-3012.34, 45.12) == "-3012 +- 45");
  CHECK(ensemble::with_error(2.5712e7, 1.234e6) == "(25.7 +- 1.2)e6");
  CHECK(ensemble::with_error(1.9e-5, 2.3e-7) == "(19.00 +- 0.23)e-6");
  CHECK(ensemble::with_error(0.18741, undefined) == "0.1874");
  CHECK(ensemble::with_error(undefined, 1) == "-");
  CHECK(ensemble::with_error(0, 0) == "0");
}

TEST_CASE("The dilation angle is that of the Mohr circle of strain increments") {
  // sin psi = -(d eps_1 + d eps_3)/(d eps_1 - d eps_3) in plane strain (Roscoe 1970).
  for (const double psi : {0.0, 5.0, 12.0, -4.0}) {
    const double sine = std::sin(psi * degree), ratio = (1 + sine) / (1 - sine);
    std::vector<records::Record> records;
    for (int k = 0; k <= 10; ++k) records.push_back(record_of(0, 1e-6 * k, -1e-6 * k * ratio, 3e4, 1e4));
    CHECK(ensemble::dilation_angle_deg(records, 5e-6) == Approx(psi).margin(1e-3));
  }
  CHECK(std::isnan(ensemble::dilation_angle_deg({}, 0)));
}

TEST_CASE("The secant at half of the peak of an elastic solid is its modulus and its Poisson's ratio") {
  const double modulus = 2e7, poisson = 0.3;
  std::vector<records::Record> records;
  for (int k = 0; k <= 20; ++k) {
    const double strain = 1e-5 * k;
    records.push_back(record_of(0, strain, -poisson * strain, 1e4 + modulus * strain, 1e4));
  }
  const auto found = ensemble::secant_at_half(records, 1, 2);
  CHECK(found.modulus == Approx(modulus));
  CHECK(found.poisson_ratio == Approx(poisson).margin(1e-4));
}

TEST_CASE("Factors of a footing are those of the tables, and the spiral is within N_q") {
  // Vesic (1973), table 1, at 30 degrees.
  CHECK(ensemble::bearing_capacity_Nc(30) == Approx(30.14).epsilon(1e-3));
  CHECK(ensemble::bearing_capacity_Ngamma(30) == Approx(22.40).epsilon(1e-3));
  for (const double phi : {10.0, 25.0, 40.0}) {
    const double wedge = std::tan(calibrate::wedge_angle_deg(phi) * degree);
    CHECK(std::pow(ensemble::spiral_ratio(phi), 2) * wedge * wedge == Approx(calibrate::bearing_capacity_Nq(phi)));
  }
}

TEST_CASE("Cycles are counted by turns until p falls below the limit of the stage") {
  const auto protocol = protocol_of(
      "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.01\nrecord_every = 1e-3\ncycles = 9\nreverse_at_Pa = 1e3\n"
      "  [[stage.until]]\n  quantity = \"p_over_first\"\n  below = 0.02\n");
  records::TestResult test;
  const double strains[] = {0, 1, 2, 1, 0, -1, -2, -1, 0, 1}, pressures[] = {10, 9, 8, 7, 6, 5, 4, 3, 2, 0.1};
  for (int k = 0; k < 10; ++k)
    test.records.push_back(record_of(0, 1e-3 * strains[k], 0, 1e3 * pressures[k], 1e3 * pressures[k]));
  const auto found = ensemble::liquefaction_of(protocol, test, 2);
  CHECK(found.cyclic);
  CHECK(found.liquefied);
  CHECK(found.cycles == 1);  // turns at 2 and at -2
  CHECK(found.stress_ratio == Approx(0.1));
  CHECK(found.limit == 0.02);
  test.records.pop_back();
  const auto before = ensemble::liquefaction_of(protocol, test, 2);
  CHECK(!before.liquefied);
  CHECK(before.least_p == Approx(0.2));
  CHECK(!ensemble::liquefaction_of(protocol_of("[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.01\n"), test, 2)
             .cyclic);
}

TEST_CASE("A summary holds each measure at each pressure, the envelope of each specimen, and the groups' difference") {
  const auto protocol = protocol_of("[[stage]]\nkind = \"compression\"\nto_strain = 0.1\n");
  // Peaks on t = s sin phi + c cos phi, with another angle in the second group.
  std::vector<ensemble::TestOf> tests;
  for (std::size_t specimen = 0; specimen < 4; ++specimen) {
    const double phi = (specimen < 2 ? 30.0 : 25.0) + double(specimen % 2), cohesion = 200;
    for (const double lateral : {1e4, 2e4}) {
      const double sine = std::sin(phi * degree), cosine = std::cos(phi * degree);
      const double s = (lateral + cohesion * cosine) / (1 - sine), t = s * sine + cohesion * cosine;
      records::TestResult test;
      for (int k = 0; k <= 4; ++k)
        test.records.push_back(
            record_of(0, 1e-3 * k, -1e-3 * k, lateral + (s + t - lateral) * std::min(k, 3) / 3, lateral));
      tests.push_back({specimen / 2, specimen, lateral, ensemble::measured(protocol, test, 2),
                       ensemble::strength_of(protocol, test, 2)});
    }
  }
  const ensemble::Summary summary = ensemble::summary_of(tests);
  const auto row = [&](std::size_t group, const std::string& name) {
    for (const auto& each : summary.rows)
      if (each.group == group && each.name == name) return each;
    FAIL("no row " << name);
    throw 0;
  };
  CHECK(row(0, "cohesion_Pa").spread.mean == Approx(200).epsilon(1e-6));
  CHECK(row(0, "cohesive_friction_angle_deg").spread.mean == Approx(30.5));
  CHECK(row(1, "cohesive_friction_angle_deg").spread.mean == Approx(25.5));
  CHECK(row(0, "cohesive_friction_angle_deg").spread.n == 2);
  CHECK(row(0, "bearing_capacity_Nq").spread.mean > calibrate::bearing_capacity_Nq(30.5));  // by the secant
  CHECK(summary.cohesive_groups.at(0) == calibrate::Cohesive::no);
  CHECK(row(0, "friction_angle_deg").pressure == 1e4);
  CHECK(row(0, "peak_strain").spread.mean == Approx(3e-3));
  bool compared = false;
  for (const auto& each : summary.comparisons)
    if (each.name == "cohesive_friction_angle_deg") {
      compared = true;
      CHECK(each.difference.value == Approx(5));
      CHECK(each.difference.standard_error == Approx(std::sqrt(0.25 + 0.25)));
    }
  CHECK(compared);

  // Where the grains of the first group stick, its factors take the line; the second group keeps the secant.
  for (auto& test : tests) test.grains_stick = test.group == 0;
  const ensemble::Summary sticking = ensemble::summary_of(tests);
  for (const auto& each : sticking.rows) {
    if (each.name != "bearing_capacity_Nq") continue;
    const double of_line = 0.5 * (calibrate::bearing_capacity_Nq(each.group == 0 ? 30 : 25) +
                                  calibrate::bearing_capacity_Nq(each.group == 0 ? 31 : 26));
    if (each.group == 0) CHECK(each.spread.mean == Approx(of_line));
    if (each.group == 1) CHECK(each.spread.mean > 1.02 * of_line);
  }
  CHECK(sticking.cohesive_groups == std::vector{calibrate::Cohesive::by_law, calibrate::Cohesive::no});
}
