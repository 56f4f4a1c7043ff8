// YADE 2023.02a: recorded stresses of its packings, and loading paths from the same recorded states. Every stress
// component of every record counts.
#include "tests/catch.hpp"
#include "tests/oracle/reference_yade.hpp"

namespace {

using namespace rvelab;
using namespace rvelab::test;

void check_path(const std::string& name, const PathDifference& found, double bar, int records) {
  CAPTURE(name, found.largest / found.pressure);
  CHECK(found.records == records);
  CHECK(found.not_held == 0);
  CHECK(found.largest <= bar * found.pressure);
}

}  // namespace

TEST_CASE("contact forces of YADE's packings add up to the stresses that it recorded", "[oracle]") {
  std::vector<std::string> names = {"dense", "medium", "soft", "soft100", "noroll", "hertz"};
  for (const char* parent : {"dense", "medium", "soft"})
    for (const char* pressure : {"_p10", "_p15", "_p20", "_p25", "_p30"})
      names.push_back(std::string(parent) + pressure);
  for (const auto& name : names) {
    const Rve rve(yade_packing(name));
    const Matrix3 difference = rve.contact_stress() - yade_stress(name);
    CAPTURE(name, difference);
    CHECK(difference.cwiseAbs().maxCoeff() <= 1e-6);
    CHECK(rve.unbalanced_ratio() <= 1e-8);
  }
}

TEST_CASE("quasi-static simple shear at constant volume gives YADE's stresses to gamma = 0.5 %", "[oracle]") {
  for (const char* name : {"dense", "medium", "soft", "noroll"})
    check_path(name, follow_shear(name, 0.005, false), 0.002, 20);
}

TEST_CASE("simple shear at YADE's own rate gives its stresses to gamma = 0.5 %", "[oracle]") {
  for (const char* name : {"dense", "medium", "soft", "noroll"})
    check_path(name, follow_shear(name, 0.005, true), 0.002, 20);
}

TEST_CASE("quasi-static biaxial compression gives YADE's stresses to 0.3 % strain", "[oracle]") {
  check_path("dense", follow_biaxial("dense_p100", "dense", 0.003, Lateral::constant, false), 0.005, 6);
  check_path("noroll", follow_biaxial("noroll_p100", "noroll", 0.003, Lateral::constant, false), 0.005, 6);
  check_path("soft", follow_biaxial("soft_p20", "soft", 0.003, Lateral::constant, false), 0.005, 6);
}

TEST_CASE("biaxial compression at YADE's own rate gives its stresses to 0.3 % strain", "[oracle]") {
  check_path("dense", follow_biaxial("dense_p100", "dense", 0.003, Lateral::constant, true), 0.005, 6);
  check_path("noroll", follow_biaxial("noroll_p100", "noroll", 0.003, Lateral::constant, true), 0.005, 6);
  check_path("soft", follow_biaxial("soft_p20", "soft", 0.003, Lateral::constant, true), 0.005, 6);
}

// YADE compresses these states at 0.06 1/s from rest. At 10 to 15 kPa that rate shows: its unbalanced ratio is 7e-3,
// its lateral stress is 1.5 % off when the first record is taken, and slower loading changes the axial stress by up to
// 2 % of P. The same test is therefore the one at its rate, under the lateral stress that its servo reached.
TEST_CASE("biaxial compression from each of YADE's states at 10 to 30 kPa gives its stresses", "[oracle]") {
  for (const char* parent : {"dense", "medium", "soft"})
    for (const char* pressure : {"_p10", "_p15", "_p20", "_p25", "_p30"}) {
      const std::string name = std::string(parent) + pressure;
      check_path(name, follow_biaxial(name + "_from_state", name, 0.0005, Lateral::as_recorded, true), 0.01, 1);
    }
}
