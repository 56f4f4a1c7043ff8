// The friction angle of the dense reference packing from the recorded stress paths, against the figures published with
// them (reference/yade: README table and biaxial_from_state_summary.json).
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "rvelab/calibrate/calibrate.hpp"
#include "tests/catch.hpp"

using namespace rvelab;

namespace {

enum class StrainMeasure { engineering, logarithmic };

/// One test a pressure. Records lie at fixed logarithmic strains, which is what a window of records counts in.
std::vector<records::TestResult> recorded_tests(StrainMeasure measure) {
  std::ifstream file(RVELAB_TEST_DATA "/yade/biaxial_dense_from_state.csv");
  REQUIRE(file);
  std::map<double, records::TestResult> tests;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || line[0] == 'P') continue;
    std::istringstream text(line);
    std::vector<double> row;
    for (std::string item; std::getline(text, item, ',');) row.push_back(std::stod(item));
    REQUIRE(row.size() == 6);
    records::Record record;
    record.strain = measure == StrainMeasure::engineering ? row[1] : -row[2];
    record.stress(0, 0) = row[3];
    record.stress(1, 1) = row[4];
    record.stress(0, 1) = record.stress(1, 0) = row[5];
    tests[row[0]].pressure = 1e3 * row[0];
    tests[row[0]].records.push_back(record);
  }
  std::vector<records::TestResult> list;
  for (const auto& [pressure, test] : tests) list.push_back(test);
  REQUIRE(list.size() == 5);
  return list;
}

}  // namespace

TEST_CASE("Recorded biaxial paths give the recorded peaks and friction angle") {
  const calibrate::Calibration found = calibrate::calibrate(recorded_tests(StrainMeasure::engineering), 2);
  const double angles[] = {31.728062998436197, 32.07090076318966, 32.03148044367511, 31.922639508553775,
                           31.917046201796435};
  for (int k = 0; k < 5; ++k) CHECK(found.per_pressure[k].friction_angle_deg == Approx(angles[k]).margin(2e-4));
  CHECK(found.per_pressure[0].peak.major == Approx(32344.402556187648).epsilon(1e-5));
  CHECK(found.per_pressure[0].peak.minor == Approx(10049.791541798215).epsilon(1e-5));
  CHECK(found.per_pressure[0].peak_strain == Approx(0.005980819625389544).margin(1e-6));
  CHECK(found.friction_angle_deg == Approx(31.94623067417852).margin(2e-4));
  CHECK(found.friction_angle_with_cohesion_deg == Approx(31.95065165214342).margin(1e-3));
  CHECK(found.cohesion == Approx(-3.6900213679960556).margin(0.5));
}

TEST_CASE("Recorded biaxial paths give the recorded angles of the 1 % moving mean") {
  const calibrate::Calibration found = calibrate::calibrate(recorded_tests(StrainMeasure::logarithmic), 2);
  const double angles[] = {30.103550523511764, 30.412411067322, 30.718931335077574, 30.751015906031594,
                           30.665456788572648};
  for (int k = 0; k < 5; ++k) {
    CHECK(found.per_pressure[k].moving_mean_friction_angle_deg == Approx(angles[k]).margin(2e-4));
  }
  CHECK(found.friction_angle_moving_mean_deg == Approx(30.530273124103115).margin(2e-4));
}

TEST_CASE("Recorded biaxial paths give the recorded angles at large strain") {
  // The reference takes the last fifth of its records, from 12.23 % on.
  const double angles[] = {22.39372063117748, 21.82315460252801, 21.957431694908195, 20.08468789546075,
                           23.94734818818361};
  const auto tests = recorded_tests(StrainMeasure::engineering);
  for (int k = 0; k < 5; ++k) {
    CHECK(calibrate::friction_angle_deg(calibrate::large_strain_mean(tests[k].records, 2, 0.1223, 0.151)) ==
          Approx(angles[k]).margin(2e-4));
  }
}
