// What interactions form from is told where it lies outside the tables and formulas of their laws.
#include <cmath>
#include <string>
#include <vector>

#include "rvelab/interaction/capillary.hpp"
#include "rvelab/interaction/outside.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

constexpr double mm = 1e-3, everything = 1e-6;  // m; m^3 of pores

/// Two pairs that touch, of 1 and of 2 mm; in the plane with a thickness.
std::vector<GrainPair> pairs(double thickness = 0, double stiffness = 0) {
  return {{mm, mm, thickness, 0, stiffness}, {2 * mm, 2 * mm, thickness, 0, stiffness}};
}

std::string told(const auto& settings, const std::vector<GrainPair>& of = pairs(), double pores = everything) {
  std::string all;
  for (const std::string& line : outside_ranges(settings, of, pores)) all += line + "\n";
  return all;
}

Water sucked(double suction) { return {0.0728, 0, suction, 0}; }
Water wetted(double volume_ratio, double angle = 0) { return {0.0728, angle, 0, volume_ratio}; }

}  // namespace

TEST_CASE("a suction outside the table of bridges is told, with the pairs and the range") {
  CHECK(told(sucked(1e3)).empty());
  CHECK_THAT(told(sucked(200)), Contains("suction_Pa = 200 is outside the table of bridges for 1 of 2 pairs (50 %)") &&
                                    Contains("its lower end") && Contains("from 242.667 to"));
  CHECK_THAT(told(sucked(100)), Contains("for 2 of 2 pairs (100 %)"));
  CHECK_THAT(told(sucked(2e6)), Contains("for 1 of 2 pairs (50 %), which take the shape at its upper end"));
  // The ends that are told are those of the table: beyond them its coefficients stay as they are.
  const auto pull = [](double suction) {
    const auto bridge = interaction::suction_bridge(suction, mm, mm, 0, 0.0728);
    return bridge.force(0).force;
  };
  CHECK(pull(240) == pull(230));
  CHECK(pull(243) != pull(246));
}

TEST_CASE("a volume below the table, bridges that would join, and too much water are told") {
  CHECK(told(wetted(1e-3)).empty());
  CHECK(told(wetted(1e-8)).empty());
  CHECK(told(wetted(1e-9)).empty());
  CHECK_THAT(told(wetted(1e-10)), Contains("volume_ratio = 1e-10 is below the table of bridges, from 1e-09 to 0.1"));
  CHECK_THAT(told(wetted(1e-8, 40)), Contains("from 1e-06 to 0.1 above 30 degrees"));
  CHECK(told(wetted(0.05)).empty());
  CHECK_THAT(told(wetted(0.08)),
             Contains("bridges of 2 of 2 pairs (100 %) are so wide that those of neighbours touch"));
  CHECK_THAT(told(wetted(1e-3), pairs(), 3e-11), Contains("the saturation is 0.3, above the pendular regime"));
  // Equal discs that touch: the half filling angle is 30 degrees where the arcs are 0.1547 r wide.
  CHECK(told(sucked(0.0728 / (0.15 * mm)), pairs(0.01)).empty());
  CHECK_THAT(told(sucked(0.0728 / (0.16 * mm)), pairs(0.01)), Contains("bridges of 1 of 2 pairs (50 %) are so wide"));
}

TEST_CASE("adhesion is told where its formula holds no longer, and which law does") {
  const double hard = 4.0 / 3 * 70e9 * std::sqrt(0.5 * mm), soft = 4.0 / 3 * 1e6 * std::sqrt(0.5 * mm);
  CHECK(told(SurfaceEnergy{0.05}, pairs(0, hard)).empty());
  CHECK_THAT(told(SurfaceEnergy{1e3}, pairs(0, soft)), Contains("presses these grains together by"));
  const std::vector<GrainPair> dust{{1e-8, 1e-8, 0, 0, 4.0 / 3 * 70e9 * std::sqrt(0.5e-8)}};
  CHECK_THAT(told(SurfaceEnergy{1e-3}, dust), Contains("Tabor's number is 0.0") && Contains("kind = \"dmt\""));
  CHECK(told(VanDerWaals{1e-3, 1e-10}, dust).empty());
  CHECK_THAT(told(VanDerWaals{0.05, 4e-10}, pairs(0, soft)), Contains("above 5") && Contains("kind = \"jkr\""));
  CHECK_THAT(told(VanDerWaals{0.05, 0.1 * mm}, pairs()), Contains("pull over 0.9 of their radius"));
}
