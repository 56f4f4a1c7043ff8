// The numbers of a data sheet, read off tests that follow published relations with known constants.
#include "rvelab/sheet/numbers.hpp"

#include <algorithm>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/sheet/element_tests.hpp"
#include "tests/catch.hpp"
#include "tests/sheet/made_tests.hpp"

using namespace rvelab;
using namespace rvelab::test;
using sheet::Number;
using sheet::numbers_by_key;
using sheet::numbers_of;
using sheet::Sheet;

namespace {

const Number& the(const Sheet& sheet, const std::string& key, const std::string& density = "", double pressure = 0) {
  for (const Number& number : sheet.numbers)
    if (number.key == key && number.density_name == density && (pressure == 0 || number.pressure == pressure))
      return number;
  throw Error("no number " + key + " " + density);
}
bool has(const Sheet& sheet, const std::string& key) {
  return std::any_of(sheet.numbers.begin(), sheet.numbers.end(), [&](const Number& each) { return each.key == key; });
}
bool remarks(const Sheet& sheet, const std::string& words) {
  return std::any_of(sheet.remarks.begin(), sheet.remarks.end(),
                     [&](const std::string& each) { return each.find(words) != std::string::npos; });
}

}  // namespace

TEST_CASE(
    "Bolton's relation, the critical angle and the critical state line are recovered from tests that follow them") {
  const Sheet sheet = numbers_of(bolton_tests(3, 9.2, 3), "sand");
  CHECK(the(sheet, "phi_cs_deg").mean == Approx(critical).epsilon(1e-6));
  CHECK(the(sheet, "M_tc").mean ==
        Approx(6 * std::sin(critical * std::numbers::pi / 180) / (3 - std::sin(critical * std::numbers::pi / 180))));
  CHECK(the(sheet, "bolton_Q").mean == Approx(9.2).epsilon(1e-5));
  CHECK(the(sheet, "bolton_Q").standard_error == Approx(0).margin(1e-10));
  CHECK(the(sheet, "bolton_scatter_deg").mean < 1e-4);
  CHECK(the(sheet, "critical_line_e_G").mean == Approx(e_G).epsilon(1e-6));
  CHECK(the(sheet, "critical_line_lambda").mean == Approx(lambda).epsilon(1e-4));
  CHECK(the(sheet, "critical_line_xi").mean == 0.7);
  // psi = e_0 - e_c(p_0) of the first record.
  const double p = 100e3, last = deviator_at(critical, p);
  CHECK(the(sheet, "state_parameter", "dense", p).mean ==
        Approx(line(p + last / 3) - 0.05 - 0.2 * 0.9 - line(p)).epsilon(1e-4));
  CHECK(the(numbers_of(bolton_tests(4.2, 10, 2), "sand"), "bolton_A_deg").mean == Approx(4.2).epsilon(1e-5));
}

TEST_CASE("the standard error is that of the seeds, and the interval Student's") {
  const Sheet sheet = numbers_of(bolton_tests(3, 10.4, 4, 0.2), "sand");
  const Number& Q = the(sheet, "bolton_Q");  // seeds with 10.1, 10.3, 10.5, 10.7
  CHECK(Q.mean == Approx(10.4).epsilon(1e-6));
  CHECK(Q.standard_error == Approx(0.2 * std::sqrt(5.0 / 3) / 2).epsilon(1e-3));
  CHECK(Q.high - Q.mean == Approx(ensemble::students_t(3) * Q.standard_error).epsilon(1e-6));
  CHECK(Q.tests.size() == 36);
}

TEST_CASE("an error estimate of the stresses becomes one of the angle, and of what is made of it") {
  std::vector<Test> tests = bolton_tests(3, 9.2, 1);
  CHECK(std::isnan(the(numbers_of(tests, "sand"), "phi_cs_deg").calculation_error));
  const double part = 1e-3;
  for (Test& test : tests)
    for (records::Record& record : test.result.records) record.error_estimate = part;
  const Sheet sheet = numbers_of(tests, "sand");
  // t + e and s + e for an error e = part p of the larger stress: d sin phi = e/s (1 + sin phi), p = s (1 - sin phi/3).
  const double sine = std::sin(critical * std::numbers::pi / 180);
  const double expected = part * (1 - sine / 3) * (1 + sine) / std::sqrt(1 - sine * sine) * 180 / std::numbers::pi;
  CHECK(the(sheet, "phi_cs_deg").calculation_error == Approx(expected).epsilon(1e-3));
  CHECK(the(sheet, "bearing_capacity_Nq").calculation_error ==
        Approx(0.5 * (calibrate::bearing_capacity_Nq(critical + expected) -
                      calibrate::bearing_capacity_Nq(critical - expected)))
            .epsilon(1e-3));
  CHECK(the(sheet, "bolton_Q").calculation_error > 0);
  CHECK(std::isnan(the(sheet, "phi_cs_deg").standard_error));
  CHECK(remarks(sheet, "There is one specimen of each density"));
}

TEST_CASE("factors of a footing are those of the angle, and their intervals those of its ends") {
  const Sheet sheet = numbers_of(bolton_tests(3, 9.2, 3, 0.1), "sand");
  const Number &angle = the(sheet, "secant_friction_angle_deg", "dense"),
               &N_q = the(sheet, "bearing_capacity_Nq", "dense"), &wedge = the(sheet, "passive_wedge_deg", "dense");
  CHECK(N_q.mean == calibrate::bearing_capacity_Nq(angle.mean));
  CHECK(N_q.low == calibrate::bearing_capacity_Nq(angle.low));
  CHECK(N_q.high == calibrate::bearing_capacity_Nq(angle.high));
  CHECK(wedge.low == 45 - angle.high / 2);  // falls as the angle rises
  CHECK(wedge.high == 45 - angle.low / 2);
}

TEST_CASE("no critical state line goes through states at one pressure, or with void ratios that rise with it") {
  std::vector<Test> one = bolton_tests(3, 9.2, 2, 0.3);
  std::erase_if(one, [](const Test& test) { return test.pressure != 100e3; });
  const Sheet sheet = numbers_of(one, "sand");
  CHECK(has(sheet, "phi_cs_deg"));
  for (const char* key : {"critical_line_e_G", "critical_line_lambda", "critical_line_Gamma", "state_parameter"})
    CHECK(!has(sheet, key));
  CHECK(remarks(sheet, "a factor of 1.2 apart"));
  std::vector<Test> rising = bolton_tests(3, 9.2, 2);
  for (Test& test : rising)
    for (records::Record& record : test.result.records) record.void_ratio += 2e-7 * test.pressure;
  const Sheet risen = numbers_of(rising, "sand");
  CHECK(!has(risen, "critical_line_e_G"));
  CHECK(!has(risen, "state_parameter"));
  CHECK(remarks(risen, "do not fall with the pressure"));
}

TEST_CASE("a slope of the critical state line that may be 0 is shown with a remark, and models do not take it") {
  const auto line_of = [](double per_pascal) {  // the slopes of three seeds differ
    std::vector<Test> tests = bolton_tests(3, 9.2, 3);
    for (Test& test : tests)
      for (records::Record& record : test.result.records)
        record.void_ratio += per_pascal * (double(test.seed) - 2) * test.pressure;
    return numbers_of(tests, "sand");
  };
  const Sheet known = line_of(1e-9), unknown = line_of(2e-7);
  CHECK(the(known, "critical_line_lambda").remark.empty());
  CHECK(numbers_by_key(known).contains("critical_line_Gamma"));
  CHECK(the(unknown, "critical_line_lambda").mean == Approx(lambda).epsilon(1e-3));
  CHECK(the(unknown, "critical_line_lambda").low < 0);
  for (const char* key : {"critical_line_lambda", "critical_line_lambda_ln", "critical_line_Gamma"}) {
    CHECK_THAT(the(unknown, key).remark,
               Catch::Matchers::Contains(key == std::string("critical_line_Gamma") ? "goes with a \u03bb that may be 0"
                                                                                   : "the interval has 0 in it"));
    CHECK(!numbers_by_key(unknown).contains(key));
  }
  CHECK(the(unknown, "critical_line_e_G").remark.empty());
  CHECK(has(unknown, "state_parameter"));
  CHECK_THAT(the(numbers_of(bolton_tests(3, 9.2, 1), "sand"), "critical_line_lambda").remark,
             Catch::Matchers::Contains("from one specimen"));
}

TEST_CASE("ends whose void ratios go up and down from seed to seed are at rest, and such that all rise are not") {
  const auto rising = [](double common, double own) {
    std::vector<Test> tests = bolton_tests(3, 9.2, 3);
    for (Test& test : tests)
      for (records::Record& record : test.result.records)
        record.void_ratio += (common + own * (double(test.seed) - 2)) * std::abs(record.strain);
    return numbers_of(tests, "sand");
  };
  // From one half of the window to the other the strain grows by 0.025.
  CHECK(!remarks(rising(0.1, 0), "critical"));
  CHECK(remarks(rising(0.2, 0), "No drained test has reached a steady void ratio"));
  CHECK(!remarks(rising(0.2, 0.03), "drained tests is known to"));
  // s = 0.02525 over the seeds: the 95 % interval of the mean, t of 18 degrees of freedom, is +-0.031 and shows no
  // more.
  CHECK(!remarks(rising(0.2, 1), "No drained test has reached a steady void ratio"));
  CHECK(remarks(rising(0.2, 1), "drained tests is known to 0.031 in e alone"));
  CHECK(remarks(rising(0.3, 1), "No drained test has reached a steady void ratio"));
  CHECK(remarks(rising(2, 1), "No drained test has reached a steady void ratio"));
}

TEST_CASE("one specimen of each density is one, whatever their seeds") {
  std::vector<Test> tests = bolton_tests(3, 9.2, 1);
  for (Test& test : tests) test.seed += test.density;
  CHECK(remarks(numbers_of(tests, "sand"), "There is one specimen of each density"));
  CHECK(!remarks(numbers_of(bolton_tests(3, 9.2, 2), "sand"), "There is one specimen of each density"));
}

TEST_CASE("factors of an angle whose interval leaves those of soils have no interval") {
  std::vector<Test> tests = bolton_tests(3, 9.2, 2, 4.0);
  const Sheet sheet = numbers_of(tests, "sand");
  const Number &angle = the(sheet, "secant_friction_angle_deg", "dense"),
               &N_q = the(sheet, "bearing_capacity_Nq", "dense");
  REQUIRE((angle.low < 0 || angle.high >= 90));
  CHECK(std::isfinite(N_q.mean));
  CHECK(std::isnan(N_q.low));
  CHECK(std::isnan(N_q.high));
}

TEST_CASE("a hyperbola gives back its failure ratio, and its stiffness the exponent") {
  const double R_f = 0.85, E_i = 80e6, m = 0.55, angle = 36;
  std::vector<Test> tests;
  for (const double p : {50e3, 100e3, 400e3})
    for (std::uint64_t seed : {1, 2})
      tests.push_back(compression(Purpose::drained, {"dense", 0, 0.8, seed, p}, [=](double strain) {
        const double q_f = deviator_at(angle, p), E = E_i * std::pow(p / 100e3, m);
        return Point{std::min(q_f, strain / (1 / E + strain * R_f / q_f)), 0, 0.7, p};
      }));
  const Sheet sheet = numbers_of(tests, "sand");
  CHECK(the(sheet, "R_f", "dense").mean == Approx(R_f).epsilon(5e-3));
  // q_f/2 is reached at eps = q_f/(2 E_i (1 - R_f/2)): the secant is E_i (1 - R_f/2).
  CHECK(the(sheet, "E50_ref_Pa", "dense").mean == Approx(E_i * (1 - R_f / 2)).epsilon(0.02));
  CHECK(the(sheet, "exponent_m", "dense").mean == Approx(m).epsilon(0.02));
  CHECK(!has(sheet, "bolton_Q"));
  CHECK(remarks(sheet, "Bolton's relation is left out: it needs two densities or more."));
  CHECK(remarks(sheet, "there is no oedometer test"));
  std::erase_if(tests, [](const Test& test) { return test.pressure != 100e3; });
  const Sheet one = numbers_of(tests, "sand");
  CHECK(the(one, "E50_ref_Pa", "dense").mean == Approx(E_i * (1 - R_f / 2)).epsilon(0.02));
  CHECK(!has(one, "exponent_m"));
  CHECK(remarks(one, "m is left out"));
}

TEST_CASE("an oedometer test gives back its moduli, Poisson's ratio and the pressure at rest") {
  const double m = 0.5, E_oed = 40e6, K0 = 0.45, C = 150e6, nu = 0.25, r = nu / (1 - nu);
  std::vector<Test> tests;
  for (const double p : {50e3, 200e3})  // for m
    tests.push_back(compression(Purpose::drained, {"dense", 0, 0.8, 1, p}, [=](double strain) {
      const double E = 60e6 * std::pow(p / 100e3, m);
      return Point{std::min(deviator_at(36, p), E * strain), 0, 0.7, p};
    }));
  Test oedometer = made_test(Purpose::oedometer, {"dense", 0, 0.8, 1, 10e3}, "oedometer_unloading");
  // d sigma = E_oed sqrt(sigma/p_ref) d eps from 10 kPa on.
  const auto strain_at = [&](double stress) {
    return 2 * std::sqrt(100e3) / E_oed * (std::sqrt(stress) - std::sqrt(10e3));
  };
  const auto add = [&](double strain, double stress, double lateral) {
    oedometer.result.records.push_back(compression_record(1, strain, {stress - lateral, strain, 0.7, lateral}));
  };
  for (int k = 0; k <= 100; ++k) {
    const double stress = 10e3 * std::pow(40.0, k / 100.0);
    add(strain_at(stress), stress, K0 * stress);
  }
  for (const double stress : {300e3, 200e3, 100e3})
    add(strain_at(400e3) - (400e3 - stress) / C, stress, K0 * 400e3 - r * (400e3 - stress));
  tests.push_back(oedometer);
  const Sheet sheet = numbers_of(tests, "sand");
  CHECK(the(sheet, "Eoed_ref_Pa", "dense").mean == Approx(E_oed).epsilon(2e-3));
  CHECK(the(sheet, "K0nc", "dense").mean == Approx(K0).epsilon(1e-9));
  CHECK(the(sheet, "nu_ur", "dense").mean == Approx(nu).epsilon(1e-9));
  // Smaller stress at both ends of the unloading: 180 kPa, and 180 - r 200 kPa.
  const double minor = 0.5 * (180e3 + 180e3 - r * 200e3), exponent = the(sheet, "exponent_m", "dense").mean;
  CHECK(exponent == Approx(m).epsilon(1e-6));
  CHECK(the(sheet, "Eur_ref_Pa", "dense").mean ==
        Approx(C * (1 + nu) * (1 - 2 * nu) / (1 - nu) * std::pow(100e3 / minor, exponent)).epsilon(1e-6));
  tests.back().result.records.resize(101);  // no unloading
  const Sheet loaded = numbers_of(tests, "sand");
  CHECK(!has(loaded, "nu_ur"));
  CHECK(remarks(loaded, "no oedometer test unloads"));
}

TEST_CASE("probes along an isotropic path give back the law of the small-strain modulus") {
  const double G_ref = 35e6, n = 0.47;
  std::vector<Test> tests;
  for (std::size_t density : {0, 1})
    for (std::uint64_t seed : {1, 2, 3}) {
      Test test;
      test.purpose = Purpose::isotropic;
      test.density = density;
      test.density_name = density == 0 ? "loose" : "dense";
      test.seed = seed;
      test.pressure = 50e3;
      test.name = test.density_name + std::to_string(seed);
      test.protocol = protocol::parse_protocol(
          "[test]\nname = \"probes\"\ndimension = 3\npressure_Pa = 50e3\n[[stage]]\nkind = "
          "\"isotropic\"\n[[stage]]\nkind = "
          "\"probe\"\n[[stage]]\nkind = \"pressure_path\"\nname = \"up\"\nto_Pa = [200e3]\n[[stage]]\nkind = "
          "\"probe\"\nname "
          "= \"second\"\n",
          "probes.toml");
      const double e = 0.8 - 0.15 * double(density);
      test.void_ratio = e;
      Point point{0, 0, e, 200e3};
      test.result.records.push_back(compression_record(2, 0, point));
      for (const double p : {50e3, 200e3}) {
        const double G = G_ref * (2.17 - e) * (2.17 - e) / (1 + e) * std::pow(p / 100e3, n);
        Eigen::MatrixXd stiffness = 3 * G * Eigen::MatrixXd::Identity(6, 6);
        stiffness.diagonal().tail(3).setConstant(G);
        test.result.probes.push_back({"probe", stiffness});
      }
      tests.push_back(test);
    }
  const Sheet sheet = numbers_of(tests, "sand");
  CHECK(the(sheet, "G_ref_Pa").mean == Approx(G_ref).epsilon(1e-9));
  CHECK(the(sheet, "G0_exponent").mean == Approx(n).epsilon(1e-9));
  CHECK(the(sheet, "G0_scatter").mean < 1e-9);
  CHECK(the(sheet, "G0_ref_Pa", "dense").mean == Approx(G_ref * 1.52 * 1.52 / 1.65).epsilon(1e-9));
  CHECK(the(sheet, "G0_Pa", "loose", 200e3).mean == Approx(G_ref * 1.37 * 1.37 / 1.8 * std::pow(2, n)).epsilon(1e-9));
  CHECK(remarks(sheet, "Friction and dilation angles are left out"));
}

TEST_CASE("loops give back the strain at which the modulus has fallen, and their damping the figure") {
  const double G0 = 60e6, gamma_07 = 2e-4, damping = 0.08;
  std::vector<Test> tests;
  for (const double amplitude : {1e-5, 5e-5, 1e-4, 2e-4, 2.4e-4, 5e-4, 2e-3}) {
    Test test = made_test(Purpose::cyclic_strain, {"dense", 0, 0.8, 1, 100e3}, "cyclic_shear");
    test.name += in_words(amplitude);
    test.amplitude = amplitude;
    test.result.axis = "xz";
    const double G = G0 / (1 + 0.385 * amplitude / gamma_07);
    for (int k = 0; k <= 600; ++k) {
      const double phase = 2 * std::numbers::pi * k / 200;
      records::Record record;
      record.stage = 1;
      record.strain = amplitude * std::sin(phase);
      record.deformation_gradient(0, 2) = record.strain;
      record.stress.diagonal().setConstant(-100e3);
      record.stress(0, 2) = record.stress(2, 0) = amplitude * G * (std::sin(phase) + 2 * damping * std::cos(phase));
      test.result.records.push_back(record);
    }
    test.result.probes.push_back({"G0", G0 * Eigen::MatrixXd::Identity(6, 6)});
    tests.push_back(test);
  }
  const Sheet sheet = numbers_of(tests, "sand");
  CHECK(the(sheet, "gamma_07", "dense").mean == Approx(gamma_07).epsilon(2e-3));
  const auto figure = std::find_if(sheet.figures.begin(), sheet.figures.end(),
                                   [](const sheet::Figure& each) { return each.key == "damping"; });
  REQUIRE(figure != sheet.figures.end());
  for (const double value : figure->series.front().y) CHECK(value == Approx(100 * damping).epsilon(1e-2));
  // Oztoprak and Bolton's mean at their reference strain: G/G0 is half.
  const auto decay = std::find_if(sheet.figures.begin(), sheet.figures.end(),
                                  [](const sheet::Figure& each) { return each.key == "decay"; });
  const auto mean = std::find_if(decay->series.begin(), decay->series.end(), [](const sheet::Series& each) {
    return each.label == "Oztoprak and Bolton 2013, mean";
  });
  for (std::size_t k = 0; k < mean->x.size(); ++k) CHECK((mean->y[k] > 0.5) == (mean->x[k] < 0.044 + 0.0007));
}

TEST_CASE("cyclic tests give back the power law of their resistance") {
  const double a = 0.35, b = 0.3;
  std::vector<Test> tests;
  for (const int cycles : {6, 14, 30}) {
    const double ratio = a * std::pow(cycles, -b), p = 100e3;
    Test test = made_test(Purpose::cyclic_stress, {"medium", 0, 0.5, 1, p}, "triaxial_cyclic",
                          {"stage.cycles.reverse_at_Pa=" + in_words(2 * ratio * p)});
    test.name += std::to_string(cycles);
    test.amplitude = ratio;
    for (int k = 0; k <= 40 * cycles; ++k) {
      const double phase = 2 * std::numbers::pi * k / 40, driven = std::sin(phase);
      const bool liquefied = k == 40 * cycles;
      // q of the whole amplitude about an isotropic start; the lateral stress is lost at the last record.
      test.result.records.push_back(compression_record(1, (liquefied ? 0.0252 : 1e-3) * (liquefied ? 1 : driven),
                                                       {2 * ratio * p * driven, 0, 0.7, liquefied ? 0.04 * p : p}));
    }
    tests.push_back(test);
  }
  const Sheet sheet = numbers_of(tests, "sand");
  for (const std::string criterion : {"ru", "strain"}) {
    CHECK(the(sheet, "cyclic_exponent_" + criterion, "medium").mean == Approx(b).epsilon(1e-4));
    CHECK(the(sheet, "CSR_15_" + criterion, "medium").mean == Approx(a * std::pow(15, -b)).epsilon(1e-4));
    CHECK(the(sheet, "CSR_20_" + criterion, "medium").mean == Approx(a * std::pow(20, -b)).epsilon(1e-4));
  }
  // One that fails within the first cycle is no fatigue: the law stays what it is.
  Test at_once = tests.front();
  at_once.name += "_at_once";
  at_once.seed = 1;
  at_once.result.records.resize(21);  // half a cycle
  at_once.result.records.push_back(tests.front().result.records.back());
  tests.push_back(at_once);
  const Sheet early = numbers_of(tests, "sand");
  CHECK(the(early, "cyclic_exponent_ru", "medium").mean == Approx(b).epsilon(1e-4));
  CHECK(remarks(early, "1 of 4 stress-controlled cyclic tests come to 2.5 % of strain within the first cycle"));
  tests.pop_back();
  std::erase_if(tests, [](const Test& test) { return test.name.ends_with("14") || test.name.ends_with("30"); });
  const Sheet one = numbers_of(tests, "sand");
  CHECK(!has(one, "CSR_15_ru"));
  CHECK(remarks(one, "no specimen comes there at two stress ratios"));
}

TEST_CASE("phase transformation is where p is least, and a test whose p only falls has none") {
  const double p = 100e3, angle = 28;
  const auto test = [&](bool turns) {
    return compression(
        Purpose::undrained, {"medium", 0, 0.5, 1, p},
        [=](double strain) {
          const double lateral = turns ? p * (0.4 + 0.6 * std::pow(strain / 0.05 - 1, 2)) : p * (1 - 4 * strain);
          return Point{deviator_at(std::min(angle * strain / 0.05, 35.0), lateral), 0, 0.75, lateral};
        },
        0.14);
  };
  const Sheet sheet = numbers_of({test(true)}, "sand");
  // p = lateral + q/3 is least a little before the lateral stress is.
  const Number& found = the(sheet, "phase_transformation_deg", "medium", p);
  double least = 1e300, expected = 0;
  for (double strain = 0; strain < 0.14; strain += 1e-5) {
    const double lateral = p * (0.4 + 0.6 * std::pow(strain / 0.05 - 1, 2));
    const double mobilised = std::min(angle * strain / 0.05, 35.0),
                 mean = lateral + deviator_at(mobilised, lateral) / 3;
    if (mean < least) least = mean, expected = mobilised;
  }
  CHECK(found.mean == Approx(expected).epsilon(0.02));
  const Sheet flowing = numbers_of({test(false)}, "sand");
  CHECK(!has(flowing, "phase_transformation_deg"));
  CHECK(remarks(flowing, "1 of 1 tests of undrained compression show no phase transformation"));
}

TEST_CASE("what grains do is that of the start, the peak and the end, and is left out where it was not recorded") {
  std::vector<Test> tests = bolton_tests(3, 9.2, 2);
  for (Test& test : tests)
    for (records::Record& record : test.result.records)
      record.coordination_number = 6 - 20 * record.strain, record.sliding_fraction = 0.1;
  const Sheet sheet = numbers_of(tests, "sand");
  CHECK(the(sheet, "coordination_number_start", "dense", 100e3).mean == Approx(6));
  CHECK(the(sheet, "coordination_number_peak", "dense", 100e3).mean == Approx(6 - 20 * 0.04));
  CHECK(the(sheet, "coordination_number_end", "dense", 100e3).mean == Approx(2));
  for (Test& test : tests)
    for (records::Record& record : test.result.records)
      record.quantities &= ~records::asked<records::CoordinationNumber>;
  const Sheet without = numbers_of(tests, "sand");
  CHECK(!has(without, "coordination_number_start"));
  CHECK(has(without, "sliding_share_end"));
  CHECK(remarks(without, "The coordination number is left out"));
}

TEST_CASE("a sheet of no test has no number, and says so of every group; one of discs names what is left out") {
  const Sheet none = numbers_of({}, "sand");
  CHECK(none.numbers.empty());
  CHECK(none.figures.empty());
  CHECK(none.remarks.size() >= 6);
  Test plane = made_test(Purpose::drained, {"dense", 0, 0.8, 1, 20e3}, "biaxial");
  plane.dimension = 2;
  plane.result.axis = "y";
  for (int k = 0; k <= 300; ++k) {
    records::Record record;
    record.stage = 1;
    record.strain = 5e-4 * k;
    record.deformation_gradient(1, 1) = 1 - record.strain;
    record.stress(0, 0) = -20e3;
    record.stress(1, 1) = -20e3 - std::min(deviator_at(25, 20e3), 1e7 * record.strain);
    plane.result.records.push_back(record);
  }
  Test oedometer = plane;
  oedometer.purpose = Purpose::oedometer;
  oedometer.name = "oedometer";
  oedometer.result.records.clear();
  for (const double stress : {20e3, 100e3, 200e3, 100e3}) {  // K0 of 0.5, unloading with nu = 0.3
    records::Record record;
    record.stage = 1;
    record.strain = 1e-8 * stress;
    record.deformation_gradient(1, 1) = 1 - record.strain;
    const bool unloads = !oedometer.result.records.empty() && oedometer.result.records.back().stress(1, 1) == -200e3;
    record.stress(0, 0) = unloads ? -70e3 : -0.5 * stress;
    record.stress(1, 1) = -stress;
    oedometer.result.records.push_back(record);
  }
  const Sheet sheet = numbers_of({plane, oedometer}, "discs");
  CHECK(the(sheet, "K0nc", "dense").mean == Approx(0.5));
  CHECK(the(sheet, "nu_ur", "dense").mean == Approx(0.3));
  CHECK(the(sheet, "phi_peak_deg", "dense", 20e3).mean == Approx(25));
  CHECK(!has(sheet, "M_tc"));
  CHECK(remarks(sheet, "The grains are discs"));
  CHECK(remarks(sheet, "There is one density"));
}
