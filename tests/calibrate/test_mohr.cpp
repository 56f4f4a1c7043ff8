// Mohr circles from formulas: principal stresses, fits, bearing capacity factors.
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "rvelab/calibrate/calibrate.hpp"
#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/error.hpp"
#include "tests/catch.hpp"

using namespace rvelab;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double degree = pi / 180;

records::Record biaxial_record(double strain, double major, double minor) {
  records::Record record;
  record.strain = strain;
  record.stress(0, 0) = -minor;
  record.stress(1, 1) = -major;
  return record;
}

/// A state on the line t = s sin phi + c cos phi.
calibrate::PrincipalStresses on_envelope(double s, double angle, double cohesion) {
  const double t = s * std::sin(angle * degree) + cohesion * std::cos(angle * degree);
  return {s + t, s - t};
}

/// A test that hardens linearly to the ratio of the angle at 1 % strain and stays there, to 15 %.
records::TestResult hardening_test(double pressure, double angle) {
  records::TestResult test;
  test.pressure = pressure;
  const double ratio = (1 + std::sin(angle * degree)) / (1 - std::sin(angle * degree));
  for (int k = 0; k <= 300; ++k) {
    const double strain = 0.0005 * k;
    test.records.push_back(
        biaxial_record(strain, pressure * (1 + (ratio - 1) * std::min(1.0, strain / 0.01)), pressure));
  }
  return test;
}

}  // namespace

TEST_CASE("Principal stresses are those of the tensor, compression positive, whatever the axes") {
  // 2D: circle with centre 30 kPa and radius 13 kPa, axes turned by 22.5 degrees; sigma_zz = 0 takes no part.
  const double c = 13e3 * std::cos(pi / 4);
  Matrix3 plane = Matrix3::Zero();
  plane << -30e3 + c, c, 0, c, -30e3 - c, 0, 0, 0, 0;
  CHECK(calibrate::principal_stresses(plane, 2).major == Approx(43e3).epsilon(1e-13));
  CHECK(calibrate::principal_stresses(plane, 2).minor == Approx(17e3).epsilon(1e-13));
  // 3D: the intermediate stress takes no part either.
  const Matrix3 turn = (Eigen::AngleAxisd(0.7, Vector3::UnitX()) * Eigen::AngleAxisd(-1.1, Vector3::UnitZ())).matrix();
  const Matrix3 solid = turn * Vector3(-100e3, -300e3, -170e3).asDiagonal() * turn.transpose();
  CHECK(calibrate::principal_stresses(solid, 3).major == Approx(300e3).epsilon(1e-13));
  CHECK(calibrate::principal_stresses(solid, 3).minor == Approx(100e3).epsilon(1e-13));
  // Rankine: sigma_1/sigma_3 = 3 is a friction angle of 30 degrees.
  CHECK(calibrate::friction_angle_deg(calibrate::principal_stresses(solid, 3)) == Approx(30).epsilon(1e-13));
  // An antisymmetric part (unbalanced torque) moves no principal stress.
  Matrix3 unbalanced = plane;
  unbalanced(0, 1) += 500;
  unbalanced(1, 0) -= 500;
  CHECK(calibrate::principal_stresses(unbalanced, 2).major == Approx(43e3).epsilon(1e-13));
}

TEST_CASE("dilation: an elastic column of Poisson's ratio 1/2 has none; tan psi of a shear plane is its opening") {
  CHECK(calibrate::dilation_angle_deg(Vector3(0.5, 0.5, -1).asDiagonal(), 3) == Approx(0).margin(1e-12));
  CHECK(calibrate::dilation_angle_deg(Vector3(1, -1, 7).asDiagonal(), 2) == Approx(0).margin(1e-12));
  CHECK(calibrate::dilation_angle_deg(Vector3(0, -1, 0).asDiagonal(), 2) == Approx(-90));  // oedometer
  Matrix3 shear = Matrix3::Zero();
  shear(0, 1) = 1;
  shear(1, 1) = std::tan(0.2);
  CHECK(calibrate::dilation_angle_deg(shear, 2) == Approx(0.2 / degree).epsilon(1e-12));
  // Triaxial: eps_v/eps_1 = -2 sin psi/(1 - sin psi).
  CHECK(calibrate::dilation_angle_deg(Vector3(1, 1, -1).asDiagonal(), 3) ==
        Approx(std::asin(1.0 / 3) / degree).epsilon(1e-12));
}

TEST_CASE("The peak is the record with the largest deviator, without smoothing") {
  std::vector<records::Record> records;
  for (int k = 0; k < 40; ++k) records.push_back(biaxial_record(0.001 * k, 20e3 + 100 * k, 10e3));
  records[17].stress(1, 1) = -60e3;  // one spike
  records[30].stress(0, 0) = -1e3;   // a larger ratio is no peak
  const calibrate::Peak highest = calibrate::peak(records, 2);
  CHECK(highest.record == 17);
  CHECK(highest.strain == Approx(0.017));
  CHECK(highest.stresses.major == Approx(60e3));
  CHECK_THROWS_AS(calibrate::peak({}, 2), InputError);
}

TEST_CASE("The peak of an extension is where the axial stress is smallest, and has the friction angle of that state") {
  // The axis is unloaded from 20 kPa until sigma_1/sigma_3 = 3 at 2 % strain, then carries more again.
  std::vector<records::Record> records;
  for (int k = 0; k <= 40; ++k) {
    const double axial = 20e3 / (k <= 20 ? 1 + 0.1 * k : 3 - 0.02 * (k - 20));
    records.push_back(biaxial_record(-0.001 * k, axial, 20e3));
  }
  const calibrate::Peak found = calibrate::peak(records, 2);
  CHECK(found.strain == Approx(-0.020));
  CHECK(found.stresses.major == Approx(20e3));
  CHECK(calibrate::friction_angle_deg(found.stresses) == Approx(30).epsilon(1e-12));
  CHECK(!calibrate::rising_at_end(records, found));
}

TEST_CASE(
    "The tensile strength is the largest tension of the minor stress, the apex where the straight envelope ends") {
  std::vector<records::Record> records;
  for (int k = 0; k <= 20; ++k) records.push_back(biaxial_record(-1e-4 * k, k <= 15 ? -2e3 * k : -5e3, 100));
  CHECK(calibrate::tensile_strength(records, 2) == Approx(30e3));
  records.resize(1);
  CHECK(calibrate::tensile_strength(records, 2) == 0);
  CHECK_THROWS_AS(calibrate::tensile_strength({}, 2), InputError);
  // Circles that touch t = s sin phi + c cos phi shrink to a point at s = -c cot phi.
  CHECK(calibrate::apex_tension(45, 10e3) == Approx(10e3));
  CHECK(calibrate::apex_tension(30, 10e3) == Approx(10e3 * std::sqrt(3)));
  CHECK(std::isnan(calibrate::apex_tension(0, 10e3)));
  CHECK(std::isnan(calibrate::apex_tension(30, -1)));
}

TEST_CASE("A test whose largest deviator stands at its end was still rising") {
  std::vector<records::Record> records;
  for (int k = 0; k <= 40; ++k) records.push_back(biaxial_record(0.001 * k, 20e3 + 100 * k, 10e3));
  CHECK(calibrate::rising_at_end(records, calibrate::peak(records, 2)));
  records[39].stress(1, 1) = -60e3;  // one that broke in the last record has a peak
  CHECK(!calibrate::rising_at_end(records, calibrate::peak(records, 2)));
  records[40].stress(1, 1) = -58e3;
  CHECK(calibrate::rising_at_end(records, calibrate::peak(records, 2)));
  records[30].stress(1, 1) = -70e3;
  CHECK(!calibrate::rising_at_end(records, calibrate::peak(records, 2)));
  records.resize(1);
  CHECK(!calibrate::rising_at_end(records, calibrate::peak(records, 2)));
}

TEST_CASE("Mean, standard deviation and standard error are those of the specimens") {
  // 2, 4, 4, 6: squares about 4 are 4, 0, 0, 4.
  const calibrate::Statistics found = calibrate::statistics({2, 4, 4, 6});
  CHECK(found.mean == 4);
  CHECK(found.standard_deviation == Approx(std::sqrt(8.0 / 3)).epsilon(1e-14));
  CHECK(found.standard_error == Approx(std::sqrt(8.0 / 3) / 2).epsilon(1e-14));
  CHECK(std::isnan(calibrate::statistics({7}).standard_deviation));
  const calibrate::Calibration two = calibrate::calibrate(
      {hardening_test(10e3, 30), hardening_test(20e3, 30), hardening_test(10e3, 24)}, 2, {0, 0, 1});
  REQUIRE(two.per_specimen.size() == 2);
  CHECK(two.per_specimen[0].friction_angle_deg == Approx(30));
  CHECK(two.per_specimen[1].friction_angle_deg == Approx(24));
  CHECK(two.friction_angle_of_specimens.mean == Approx(27));
  CHECK(two.friction_angle_of_specimens.standard_deviation == Approx(std::sqrt(18.0)));
  CHECK(two.friction_angle_of_specimens.standard_error == Approx(3));
  CHECK(two.Nq_of_specimens.mean ==
        Approx(0.5 * (calibrate::bearing_capacity_Nq(30) + calibrate::bearing_capacity_Nq(24))));
}

TEST_CASE("A moving mean over 1 % of strain divides a lone spike by its number of records") {
  std::vector<records::Record> records;
  for (int k = 0; k <= 100; ++k) records.push_back(biaxial_record(0.0005 * k, 30e3, 10e3));
  records[50].stress(1, 1) = -50e3;
  CHECK(calibrate::peak_of_moving_mean(records, 2).major == Approx(30e3 + 20e3 / 20).epsilon(1e-12));
  CHECK(calibrate::peak_of_moving_mean(records, 2).minor == Approx(10e3).epsilon(1e-12));
  CHECK(calibrate::peak_of_moving_mean(records, 2, 0.005).major == Approx(30e3 + 20e3 / 10).epsilon(1e-12));
  // A test shorter than the window has none.
  records.resize(19);
  CHECK(std::isnan(calibrate::peak_of_moving_mean(records, 2).major));
  records.resize(1);
  CHECK(std::isnan(calibrate::peak_of_moving_mean(records, 2).major));
}

TEST_CASE("The large-strain stress is the mean from 12 to 15 % and nothing where a test does not reach it") {
  std::vector<records::Record> records;
  for (int k = 0; k <= 320; ++k) {
    const double strain = 0.0005 * k;
    const bool inside = k >= 240 && k <= 300;
    records.push_back(biaxial_record(strain, inside ? 20e3 + (k - 270) * 50 : 90e3, 10e3));
  }
  CHECK(calibrate::large_strain_mean(records, 2).major == Approx(20e3).epsilon(1e-12));
  CHECK(calibrate::large_strain_mean(records, 2).minor == Approx(10e3).epsilon(1e-12));
  records.resize(290);
  CHECK(std::isnan(calibrate::large_strain_mean(records, 2).major));
}

TEST_CASE("The standard errors of a straight envelope are those that scattered peaks have") {
  // Peaks at the same s with errors of t drawn anew: the fits scatter as each fit says of itself.
  std::mt19937 random(5);
  std::normal_distribution<double> error(0, 300);
  const int draws = 4000;
  double squares_c = 0, squares_phi = 0, said_c = 0, said_phi = 0;
  for (int k = 0; k < draws; ++k) {
    std::vector<calibrate::PrincipalStresses> tests;
    for (const double s : {15e3, 22e3, 31e3, 39e3, 50e3}) {
      const double t = s * std::sin(30 * degree) + 2500 * std::cos(30 * degree) + error(random);
      tests.push_back({s + t, s - t});
    }
    const calibrate::CohesionFit fit = calibrate::fit_with_cohesion(tests);
    squares_c += std::pow(fit.cohesion - 2500, 2) / draws;
    squares_phi += std::pow(fit.friction_angle_deg - 30, 2) / draws;
    said_c += std::pow(fit.cohesion_error, 2) / draws;
    said_phi += std::pow(fit.friction_angle_error_deg, 2) / draws;
  }
  CHECK(said_c / squares_c == Approx(1).margin(0.1));
  CHECK(said_phi / squares_phi == Approx(1).margin(0.1));
  CHECK(std::isnan(
      calibrate::fit_with_cohesion(std::vector<calibrate::PrincipalStresses>{{3, 1}, {7, 2}}).cohesion_error));
}

TEST_CASE("States on a Coulomb envelope give back its angle and cohesion") {
  for (const double angle : {5.0, 28.1, 44.0}) {
    std::vector<calibrate::PrincipalStresses> frictional, cohesive, overshooting;
    for (const double s : {12e3, 19e3, 41e3, 77e3}) {
      frictional.push_back(on_envelope(s, angle, 0));
      cohesive.push_back(on_envelope(s, angle, 2500));
      overshooting.push_back(on_envelope(s, angle, -700));
    }
    CHECK(calibrate::friction_angle_through_origin_deg(frictional) == Approx(angle).epsilon(1e-12));
    CHECK(calibrate::fit_with_cohesion(cohesive).friction_angle_deg == Approx(angle).epsilon(1e-11));
    CHECK(calibrate::fit_with_cohesion(cohesive).cohesion == Approx(2500).epsilon(1e-9));
    CHECK(calibrate::fit_with_cohesion(overshooting).cohesion == Approx(-700).epsilon(1e-9));
    CHECK(calibrate::friction_angle_through_origin_deg(cohesive) > angle);
  }
}

TEST_CASE("The fit through the origin weighs tests by least squares of t in s") {
  // sum(s t)/sum(s s) for (1, 0.5), (2, 0.8): 2.1/5.
  const std::vector<calibrate::PrincipalStresses> tests{{1.5, 0.5}, {2.8, 1.2}};
  CHECK(calibrate::friction_angle_through_origin_deg(tests) == Approx(std::asin(0.42) / degree).epsilon(1e-13));
  // One test has no cohesion to tell.
  CHECK(std::isnan(calibrate::fit_with_cohesion(std::vector<calibrate::PrincipalStresses>{{3, 1}}).cohesion));
}

TEST_CASE("Bearing capacity factors of 28.1 degrees are 14.883 and 6.147, its wedge stands at 59.05 degrees") {
  CHECK(calibrate::bearing_capacity_Nq(28.1) == Approx(14.883).margin(5e-4));
  CHECK(calibrate::local_shear_Nq(28.1) == Approx(6.147).margin(5e-4));
  CHECK(calibrate::wedge_angle_deg(28.1) == Approx(59.05).epsilon(1e-14));
  CHECK(calibrate::bearing_capacity_Nq(0) ==
        Approx(1).epsilon(1e-14));  // Prandtl: without friction the surcharge alone
}

TEST_CASE("Cohesion is that of the law, or of a line whose c is beyond its error and a share of the stress") {
  using calibrate::Cohesive;
  const auto tests = [](double angle, double cohesion, double scatter) {
    std::vector<calibrate::PrincipalStresses> found;
    double sign = 1;
    for (const double s : {50e3, 100e3, 150e3, 200e3, 250e3}) {
      auto one = on_envelope(s, angle, cohesion);
      one.major += sign * scatter * s, one.minor -= sign * scatter * s;
      sign = -sign;
      found.push_back(one);
    }
    return found;
  };
  CHECK(calibrate::cohesive(tests(30, 0, 0), false) == Cohesive::no);
  CHECK(calibrate::cohesive(tests(30, 0, 0), true) == Cohesive::by_law);
  CHECK(calibrate::cohesive(tests(30, 20e3, 1e-3), false) == Cohesive::by_line);  // mean stress 150 kPa
  CHECK(calibrate::cohesive(tests(30, 5e3, 1e-4), false) == Cohesive::no);        // beyond its error, below 5 %
  CHECK(calibrate::cohesive(tests(30, 9e3, 0.05), false) == Cohesive::no);        // above 5 %, within its error
  CHECK(calibrate::cohesive(tests(30, -20e3, 1e-3), false) == Cohesive::no);
  // Two tests have no error.
  const std::vector<calibrate::PrincipalStresses> two{on_envelope(50e3, 30, 20e3), on_envelope(90e3, 30, 20e3)};
  CHECK(calibrate::cohesive(two, false) == Cohesive::no);
  CHECK(calibrate::cohesive(two, true) == Cohesive::by_law);

  CHECK(calibrate::strength_angle_deg(tests(30, 20e3, 0), Cohesive::by_line) == Approx(30).epsilon(1e-10));
  CHECK(calibrate::strength_angle_deg(tests(30, 20e3, 0), Cohesive::no) > 33);
}

TEST_CASE("N_c is that of the tables, and goes to pi + 2 without friction") {
  CHECK(calibrate::bearing_capacity_Nc(30) == Approx(30.14).epsilon(1e-3));  // Vesic (1973), table 1
  CHECK(calibrate::bearing_capacity_Nc(20) == Approx(14.83).epsilon(1e-3));
  CHECK(calibrate::bearing_capacity_Nc(0) == Approx(pi + 2));
  CHECK(calibrate::bearing_capacity_Nc(1e-4) == Approx(pi + 2).epsilon(1e-4));
}

TEST_CASE("A soil whose grains stick takes N_q, N_c and wedge of the line, at whatever pressures it is tested") {
  const auto at = [](double lateral) {
    records::TestResult test;
    test.pressure = lateral;
    const double sine = std::sin(20 * degree), cosine = std::cos(20 * degree), c = 30e3;
    const double s = (lateral + c * cosine) / (1 - sine), t = s * sine + c * cosine;
    for (int k = 0; k <= 300; ++k)
      test.records.push_back(biaxial_record(0.0005 * k, lateral + 2 * t * std::min(1.0, k / 20.0), lateral));
    return test;
  };
  const auto low = calibrate::calibrate({at(20e3), at(50e3), at(100e3)}, 2, {}, true);
  const auto high = calibrate::calibrate({at(200e3), at(500e3), at(900e3)}, 2, {}, true);
  for (const auto& found : {low, high}) {
    CHECK(found.cohesive == calibrate::Cohesive::by_law);
    CHECK(found.friction_angle_deg == Approx(20).epsilon(1e-9));
    CHECK(found.cohesion == Approx(30e3).epsilon(1e-7));
    CHECK(found.bearing_capacity_Nq == Approx(6.399).epsilon(1e-3));
    CHECK(found.bearing_capacity_Nc == Approx(14.83).epsilon(1e-3));
    CHECK(found.wedge_angle_deg == Approx(55).epsilon(1e-9));
    CHECK(found.per_specimen.at(0).bearing_capacity_Nq == Approx(6.399).epsilon(1e-3));
  }
  CHECK(low.secant_friction_angle_deg > high.secant_friction_angle_deg + 5);
  // One pressure leaves friction and cohesion undivided.
  const auto one = calibrate::calibrate({at(50e3)}, 2, {}, true);
  CHECK(std::isnan(one.friction_angle_deg));
  CHECK(std::isnan(one.bearing_capacity_Nq));
  CHECK(one.secant_friction_angle_deg > 25);
}

TEST_CASE("Tests of one frictional soil at any pressures calibrate to its angle") {
  const calibrate::Calibration found = calibrate::calibrate({hardening_test(10e3, 30), hardening_test(25e3, 30)}, 2);
  CHECK(found.friction_angle_deg == Approx(30).epsilon(1e-12));
  CHECK(found.friction_angle_with_cohesion_deg == Approx(30).epsilon(1e-10));
  CHECK(found.cohesion == Approx(0).margin(1e-6));
  CHECK(found.friction_angle_moving_mean_deg == Approx(30).epsilon(1e-12));
  CHECK(found.large_strain_friction_angle_deg == Approx(30).epsilon(1e-12));
  // tan^2(60) exp(pi tan 30) = 3 exp(pi/sqrt 3)
  CHECK(found.bearing_capacity_Nq == Approx(3 * std::exp(pi / std::sqrt(3.0))).epsilon(1e-10));
  CHECK(found.wedge_angle_deg == Approx(60).epsilon(1e-12));
  REQUIRE(found.per_pressure.size() == 2);
  CHECK(found.per_pressure[1].pressure == 25e3);
  CHECK(found.per_pressure[1].peak.major == Approx(75e3).epsilon(1e-12));
  CHECK(found.per_pressure[1].peak.minor == Approx(25e3).epsilon(1e-12));
  CHECK(found.per_pressure[1].records == 301);
}

TEST_CASE("A calibration looks at the last stage only and counts its flagged records") {
  records::TestResult test = hardening_test(10e3, 30);
  for (auto& record : test.records) record.stage = 1;
  test.records[5].target_held = false;
  test.records[9].target_held = false;
  records::Record before = biaxial_record(0, 900e3, 10e3);  // a higher stress in the stage before
  before.target_held = false;
  test.records.insert(test.records.begin(), before);
  const calibrate::Calibration found = calibrate::calibrate({test}, 2);
  CHECK(found.friction_angle_deg == Approx(30).epsilon(1e-12));
  CHECK(found.per_pressure[0].records == 301);
  CHECK(found.per_pressure[0].flagged == 2);
  CHECK_THROWS_AS(calibrate::calibrate({}, 2), InputError);
}
