// The product's main job against YADE: the dense packing unloaded from 100 kPa to 10 to 30 kPa, compressed biaxially to
// 15 %, and its friction angle read off the five tests.
#include "rvelab/calibrate/calibrate.hpp"
#include "tests/catch.hpp"
#include "tests/oracle/reference_yade.hpp"
#include "tests/side_by_side.hpp"

TEST_CASE("five biaxial tests of YADE's dense packing give its friction angle", "[oracle][slow]") {
  using namespace rvelab;
  std::vector<protocol::Protocol> protocols;
  for (const char* pressure : {"10e3", "15e3", "20e3", "25e3", "30e3"})
    protocols.push_back(protocol::read_protocol(std::string(RVELAB_SOURCE_DIR) + "/protocols/biaxial.toml",
                                                {std::string("test.pressure_Pa=") + pressure}));
  calibrate::check_calibratable(protocols.front());
  std::vector<records::TestResult> results;
  for (const auto& run : test::run_all(protocols, {test::yade_packing("dense")}, 0)) results.push_back(run.result);
  const calibrate::Calibration found = calibrate::calibrate(results, 2);

  // YADE: 31.97 and 30.55 degrees, with a scatter of 0.01 between repeats; half a degree is the bar.
  CHECK(found.friction_angle_deg == Approx(31.97).margin(0.5));
  CHECK(found.friction_angle_moving_mean_deg == Approx(30.55).margin(0.5));
  std::size_t flagged = 0;
  for (const auto& test : found.per_pressure) {
    CAPTURE(test.pressure, test.flagged, test.wall_seconds, test.friction_angle_deg);
    CHECK(test.records == 301);  // none skipped: the start and each 0.05 %
    CHECK(test.peak_strain < 0.02);
    flagged += test.flagged;
  }
  // Avalanches at large strain are what a record may fail to hold: rare, and never the rule.
  CHECK(flagged <= 30);
}
