// Features of curves whose formulas are known, and cycles of a sine.
#include "rvelab/ensemble/features.hpp"

#include <cmath>
#include <numbers>

#include "rvelab/ensemble/cyclic.hpp"
#include "tests/catch.hpp"
#include "tests/ensemble/made_records.hpp"

using namespace rvelab;
using namespace rvelab::ensemble;
using test::biaxial_record;

namespace {

constexpr double p0 = 1e5;

double feature(const std::string& name, const TestPath& path) { return value_of(feature_of(name).value(), path); }

/// q = Q eps/(eps + a), Kondner's hyperbola, with eps_v = c eps - d eps^2; records every `step` up to `end`.
struct Hyperbola {
  double Q = 3e5, a = 0.004, c = 0.3, d = 4;
  double q(double strain) const { return Q * strain / (strain + a); }
  double eps_v(double strain) const { return c * strain - d * strain * strain; }
  records::TestResult test(double step, double end) const {
    records::TestResult result;
    for (int k = 0; k <= int(std::round(end / step)); ++k) {
      const double strain = step * k;
      result.records.push_back(biaxial_record(strain, 1 - (1 - eps_v(strain)) / (1 - strain), p0 + q(strain), p0));
    }
    return result;
  }
};

}  // namespace

TEST_CASE("Features of a hyperbola are those of its formula") {
  const Hyperbola soil;
  const TestPath path = path_of(soil.test(1e-4, 0.16), 2, false, 0.16);
  for (const double percent : {0.1, 0.5, 1.0, 2.0, 5.0})
    CHECK(feature("q_at_" + std::to_string(percent) + "_percent_Pa", path) ==
          Approx(soil.q(0.01 * percent)).epsilon(1e-6));
  for (const double percent : {2.0, 5.0, 15.0})
    CHECK(feature("eps_v_at_" + std::to_string(percent) + "_percent", path) ==
          Approx(soil.eps_v(0.01 * percent)).epsilon(1e-6));
  // The mean over the last per cent: q rises.
  const double largest = soil.Q * (1 - soil.a / 0.01 * std::log((0.16 + soil.a) / (0.15 + soil.a)));
  CHECK(feature("largest_q_Pa", path) == Approx(largest));
  CHECK(feature("last_q_Pa", path) == Approx(soil.q(0.16)));
  // q = share Q at eps = a share/(1 - share)
  const auto strain_at = [&](double q) { return soil.a * q / (soil.Q - q); };
  CHECK(feature("strain_at_95_percent_of_q", path) == Approx(strain_at(0.95 * largest)).epsilon(1e-4));
  CHECK(feature("E50_Pa", path) == Approx(0.5 * largest / strain_at(0.5 * largest)).epsilon(1e-3));
  CHECK(feature("p_at_2_percent_Pa", path) == Approx(p0 + 0.5 * soil.q(0.02)));
  // Up to 3 %: what lies beyond is not there, and the last value is that of the end.
  const TestPath early = path_of(soil.test(1e-4, 0.16), 2, false, 0.03);
  CHECK(feature("last_q_Pa", early) == Approx(soil.q(0.03)));
  CHECK(std::isnan(feature("q_at_5_percent_Pa", early)));
  CHECK(std::isnan(feature("eps_v_at_5_percent", early)));
}

TEST_CASE("An extension has the features of its sizes") {
  records::TestResult extension;
  for (int k = 0; k <= 100; ++k) extension.records.push_back(biaxial_record(-1e-4 * k, 0, p0 - 400 * k, p0));
  const TestPath path = path_of(extension, 2, false, 1);
  CHECK(feature("q_at_0.5_percent_Pa", path) == Approx(400 * 50));
  CHECK(feature("largest_q_Pa", path) == Approx(400 * (100 - 0.25 * 0.5 * 100)));  // mean over the last quarter of 1 %
}

TEST_CASE("Fluctuations about a plateau do not raise the largest q") {
  const double plateau = 3e5;
  records::TestResult test;
  for (int k = 0; k <= 320; ++k) {  // of 10 % and a period of 0.2 % of strain
    const double q = plateau * (std::min(1.0, k / 40.0) + 0.1 * (k % 4 == 1) - 0.1 * (k % 4 == 3));
    test.records.push_back(biaxial_record(5e-4 * k, 0, p0 + q, p0));
  }
  CHECK(feature("largest_q_Pa", path_of(test, 2, false, 0.16)) == Approx(plateau).epsilon(0.01));
}

TEST_CASE("Phase transformation is where p is least") {
  // p = p0 (1 - 40 eps + 1000 eps^2): least at 2 %, q = p
  TestPath path;
  for (int k = 0; k <= 500; ++k) {
    const double strain = 1e-4 * k, p = p0 * (1 - 40 * strain + 1000 * strain * strain);
    path.strain.push_back(strain);
    path.p.push_back(p);
    path.q.push_back(1.2 * p);
  }
  CHECK(feature("p_at_phase_transformation_Pa", path) == Approx(0.6 * p0));
  CHECK(feature("q_at_phase_transformation_Pa", path) == Approx(0.72 * p0));
  path.p.clear();
  CHECK(std::isnan(feature("q_at_phase_transformation_Pa", path)));
}

TEST_CASE("Grains that flow without effective stress keep it; a test that ends otherwise is too short") {
  for (const double end : {5e-4, 0.5}) {  // of p at the start
    records::TestResult test;
    for (int k = 0; k <= 100; ++k) {
      const double p = p0 * (1 - (1 - end) * 0.01 * k);
      test.records.push_back(biaxial_record(1e-4 * k, 0, 1.5 * p, 0.5 * p));
    }
    const double later = feature("p_at_5_percent_Pa", path_of(test, 2, false, 0.1));
    if (end < 0.01) CHECK(later == Approx(end * p0));
    if (end > 0.01) CHECK(std::isnan(later));
  }
}

TEST_CASE("An oedometer test has both branches, over all stages without lateral strain") {
  // eps = C ln(sigma/sigma_0) in loading, C/5 in unloading; the isotropic stage before has lateral strain.
  constexpr double C = 0.004, first = 1e4, most = 4e5;
  records::TestResult test;
  test.axis = "y";
  test.records.push_back(biaxial_record(0.01, 0.01, first, first));
  constexpr int steps = 400;
  const double end = C * std::log(most / first);
  for (const int stage : {1, 2})
    for (int k = 0; k <= steps; ++k) {
      const double part = double(k) / steps;
      const double strain = stage == 1 ? part * end : end - part * end / 5;
      const double stress = first * std::exp((stage == 1 ? part : 1 - part) * std::log(most / first));
      const double own = stage == 1 ? strain : 1 - (1 - strain) / (1 - end);  // from the start of its stage
      test.records.push_back(biaxial_record(own, 0, stress, 0.5 * stress));
      test.records.back().stage = stage;
    }
  const TestPath path = path_of(test, 2, true, 1);
  for (const double kPa : {50.0, 100.0, 400.0})
    CHECK(feature("loading_strain_at_" + std::to_string(kPa) + "_kPa", path) ==
          Approx(C * std::log(1e3 * kPa / first)).epsilon(1e-4));
  for (const double kPa : {100.0, 50.0})
    CHECK(feature("unloading_strain_at_" + std::to_string(kPa) + "_kPa", path) ==
          Approx(end - C / 5 * std::log(most / (1e3 * kPa))).epsilon(1e-4));
  CHECK(std::isnan(feature("loading_strain_at_800_kPa", path)));
  CHECK(std::isnan(feature("unloading_strain_at_5_kPa", path)));
}

TEST_CASE("Names of features hold their numbers, and what is none is none") {
  CHECK(feature_of("q_at_0.1_percent_Pa")->at == Approx(0.001));
  CHECK(feature_of("unloading_strain_at_50_kPa")->at == 50e3);
  for (const char* name : {"q_at_percent_Pa", "q_at_x_percent_Pa", "q_at_-1_percent_Pa", "q_at_1_percent", "E50", ""})
    CHECK(!feature_of(name));
  for (const TestKind kind : {TestKind::drained, TestKind::undrained, TestKind::oedometer})
    for (const Feature& each : usual_features(kind)) CHECK(each.scatter_of(0.01) > 0);
  CHECK(feature_of("largest_q_Pa", TestKind::undrained)->relative == 0.1);
}

TEST_CASE("Cycles are counted as those of a sine, to a pore pressure and to an amplitude") {
  // The lateral stress falls linearly with the number of cycles, to 5 % after 9.5; strain grows as N/400.
  constexpr double q = 3e4;
  std::vector<records::Record> records;
  for (int k = 0; k <= 12 * 400; ++k) {
    const double cycles = k / 400.0, phase = 2 * std::numbers::pi * cycles;
    const double lateral = std::max(0.0, p0 * (1 - 0.1 * cycles));
    records.push_back(biaxial_record(cycles / 400 * std::sin(phase), 0, lateral + q * std::sin(phase), lateral));
  }
  const protocol::Cycles by_stress{100, q};
  const CyclesTo found = cycles_to(records, "y", by_stress, 0.03, 2);
  // Between turns the driving stress measures the way: 9.5 is halfway between turns at 9.25 and 9.75.
  CHECK(found.pore_pressure == Approx(9.5).margin(0.01));
  // 10.25/400 = 0.0256 at the turn of the eleventh cycle; 2.5 % just before it.
  CHECK(found.strain == Approx(10.2).margin(0.08));
  const CyclesTo short_test = cycles_to(std::span(records).first(2000), "y", by_stress, 0.03, 2);
  CHECK(std::isnan(short_test.pore_pressure));
  CHECK(std::isnan(short_test.strain));
  // Strain-controlled: the amplitude is given, and no strain is looked for.
  records.clear();
  for (int k = 0; k <= 4 * 400; ++k) {
    const double cycles = k / 400.0;
    records.push_back(test::shear_record(0.03 * std::sin(2 * std::numbers::pi * cycles), 0, p0 * (1 - 0.3 * cycles)));
  }
  const CyclesTo strained = cycles_to(records, "xy", {10, 0}, 0.03, 2);
  CHECK(strained.pore_pressure == Approx(0.95 / 0.3).margin(0.06));  // by the strain, not by the time
  CHECK(std::isnan(strained.strain));
  // Grains that flow: the stress falls to 0 in the first quarter, while they strain to 3 %. Nothing goes back in time.
  records.clear();
  for (int k = 0; k <= 300; ++k) {
    const double driving = q * (k <= 150 ? k / 200.0 : 0), lateral = k <= 150 ? p0 : 0;
    records.push_back(biaxial_record(1e-4 * k, 0, lateral + driving, lateral));
  }
  const CyclesTo flowing = cycles_to(records, "y", by_stress, 0.1, 2);
  CHECK(flowing.pore_pressure == Approx(0.25 * 0.75));
  CHECK(flowing.strain == Approx(0.25 * 0.75));
}
