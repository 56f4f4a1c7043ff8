// Saturated scenes: what is refused, and with which remedy; runs that are stopped, resumed, spread over threads.
#include "tests/mpm/scene_runs.hpp"
#include "tests/mpm/scenes.hpp"

using namespace mpm;
using namespace mpm::test;
using Catch::Matchers::Contains;

namespace {

const std::string harmonic = "shaking = { axis = \"x\", velocity_m_s = 0.05, frequency_Hz = 5 }";
const std::string base = boundary("base", "fixed", "y", "0"), left = boundary("left", "roller", "x", "0");
const std::string footing = box_body("footing", "[1, 1.75]", "[0.5, 0.5]", "motion = [[0, 0, -0.05]]\n");

/// A saturated layer under a dry one, shaken, loaded on a strip, with water at a head on the right.
const std::string shaken = head("shaken", "0.25", "0.05") + "[loads]\ngravity_m_s2 = [0, -9.81]\n" + harmonic +
                           "\nstrip = [{ lower_m = 0, upper_m = 0.5, history = [[0, 0], [0.01, 1e3]] }]\n"
                           "[initial]\nstress = \"geostatic\"\nsurface_m = 1.5\n"
                           "[fluid]\nconductivity_m_s = 1e-3\nporosity = 0.3\nwater_table_m = 1\n" +
                           soil_of("sand", "mohr_coulomb", "1855", "1e7") + region("sand", "[0, 0]", "[2, 1]") +
                           region("sand", "[0, 1]", "[2, 1.5]", "saturated = false\n") + left +
                           boundary("right", "roller", "x", "2", below + "head_m = 1\n") + base + footing +
                           "[output]\nwatched_points_m = [[0.5, 0.5]]\n";

void expect_shaken(const std::vector<Said>& cases) { expect_said(shaken, cases, 1); }

}  // namespace

TEST_CASE("Keys of saturated soil that are wrong are refused, with the key and the remedy") {
  expect_shaken({{{}, {"accepted"}},
                 {set("fluid.conductivity_m_s=0"), {"fluid.conductivity_m_s = 0", "range"}},
                 {edit("conductivity_m_s = 1e-3\n", ""), {"fluid.conductivity_m_s is missing"}},
                 {set("fluid.conductivty_m_s=1"), {"nearest known key is fluid.conductivity_m_s"}},
                 {set("fluid.bulk_modulus_Pa=-1"), {"fluid.bulk_modulus_Pa = -1", "range"}},
                 {set("fluid.density_kg_m3=0"), {"fluid.density_kg_m3 = 0", "allowed"}},
                 {set("fluid.porosity=1.5"), {"fluid.porosity = 1.5", "allowed"}},
                 {edit("porosity = 0.3\n", ""), {"set fluid.porosity or its porosity"}},
                 {set("fluid.free_surface=open"), {"allowed: drained, membrane"}},
                 {set("fluid.water_table_m=0.5"), {"fluid.water_table_m = 0.5", "saturated = false"}},
                 {set("fluid.water_table_m=2"), {"fluid.water_table_m = 2", "initial.surface_m = 1.5"}},
                 {set("region.0.saturated=false"), {"set saturated = true in one"}},
                 {set("region.0.porosity=0"), {"region.porosity = 0", "allowed"}},
                 {set("region.0.points_per_cell=1"), {"points_per_cell is 1", "fewer than 4"}},
                 {set("time.scheme=musl"), {"set time.scheme = \"usf\""}},
                 {edit("head_m = 1\n", "head_m = 1\ndrained = true\n"), {"say the same thing twice"}},
                 {edit("head_m = 1\n", "head_m = \"up\"\n"), {"boundary.head_m", "give a number"}},
                 {edit("[fluid]\nconductivity_m_s = 1e-3\nporosity = 0.3\nwater_table_m = 1\n", ""),
                  {"the scene has no [fluid]; add it, or remove the key"}},
                 {set("loads.gravity_m_s2=[0, 0]"), {"needs gravity"}},
                 {set("fluid.follows_void_ratio=1"), {"fluid.follows_void_ratio", "true or false"}}});
}

TEST_CASE("Loads in time that are wrong are refused, with the key and the remedy") {
  const auto shaking = [&](const std::string& to) {
    Change change = edit(harmonic, "shaking = { " + to + " }");
    change.files = {{"good.csv", "time,acceleration\n0,0\n0.1,1.5\n0.2,0\n"}, {"bad.csv", "0,0\n0.1,much\n"}};
    return change;
  };
  expect_shaken({{shaking("record_csv = \"good.csv\""), {"accepted"}},
                 {shaking("record_csv = \"bad.csv\""), {"bad.csv:2: holds much"}},
                 {shaking("record_csv = \"none.csv\""), {"none.csv: no such file", "loads.shaking.record_csv"}},
                 {shaking("record = [[0, 1], [0, 2]]"), {"must go forward in time"}},
                 {shaking("record = [[0, 1], [1, 2]], frequency_Hz = 2"), {"is of harmonic shaking"}},
                 {shaking("velocity_m_s = 1"), {"loads.shaking.frequency_Hz is missing"}},
                 {shaking("velocity_m_s = 1, frequency_Hz = 0"), {"frequency_Hz = 0", "range"}},
                 {shaking("axis = \"z\", velocity_m_s = 1, frequency_Hz = 1"), {"allowed: x, y"}},
                 {edit("upper_m = 0.5, history", "upper_m = -0.5, history"), {"strip.upper_m must be above"}},
                 {edit(", history = [[0, 0], [0.01, 1e3]]", ""), {"give rows [s, Pa], or a pulse"}}});
}

TEST_CASE("Absorbing and periodic boundaries that are wrong are refused, with the key and the remedy") {
  const auto at_base = [](const std::string& more) {
    return edit(base, boundary("base", "absorbing", "y", "0", "density_kg_m3 = 2600\n" + more));
  };
  const auto at_left = [](const std::string& more) { return edit(left, boundary("left", "periodic", "x", "0", more)); };
  const std::string fast = "shear_wave_m_s = 500\n";
  expect_shaken({{at_base(fast), {"accepted"}},
                 {at_base(fast + "motion = [[0, 0, 0], [0.01, 0.1, 0]]\n"), {"accepted"}},
                 {at_base(""), {"boundary.shear_wave_m_s is missing"}},
                 {at_base("shear_wave_m_s = -1\n"), {"boundary.shear_wave_m_s = -1", "range"}},
                 {at_base(fast + "motion = [[0, 0, 0.1]]\n"), {"boundary.motion", "along the plane"}},
                 {at_left(""), {"boundary.to_m is missing"}},
                 {at_left("to_m = -1\n"), {"boundary.to_m", "upper of two planes"}},
                 {at_left("to_m = 1.9\n"), {"boundary.left.to_m = 1.9"}},
                 {at_left("to_m = 2.1\n"), {"to_m must be a whole number of cells"}}});
}

TEST_CASE("Water that is enclosed and cannot be compressed is refused for want of a datum") {
  std::string closed = shaken;
  for (const std::string key : {"head_m = 1\n", "saturated = false\n", "water_table_m = 1\n"})
    closed = edited(closed, key, "");
  closed = edited(closed, footing, boundary("lid", "roller", "y", "1.5", below));
  expect_said(
      closed,
      {{{}, {"its pressure has no datum", "fluid.bulk_modulus_Pa"}}, {set("fluid.bulk_modulus_Pa=2e9"), {"accepted"}}},
      1);
}

TEST_CASE("A saturated run that was stopped goes on with the same bytes, over any number of threads") {
  const SceneRuns bench(shaken);
  REQUIRE(bench.start("a", {"-q", "-j", "1"}) == 0);
  REQUIRE(bench.start("b", {"-q", "-j", "3", "--stop-at", "0.02"}) == 0);
  REQUIRE(bench.resume("b", {"-q", "-j", "2"}) == 0);
  bench.expect_same("a", "b", 24);
}

TEST_CASE("Energy of a shaken, loaded, saturated scene is accounted for, drained and undrained") {
  const SceneRuns bench(shaken);
  const std::string conductivity = GENERATE("1e-3", "1e-9");
  CAPTURE(conductivity);
  REQUIRE(bench.start("a", {"-q", "-j", "1", "--set", "fluid.conductivity_m_s=" + conductivity}) == 0);
  const auto history = bench.history("a");
  const auto last = [&](const char* name) { return std::abs(history.last(name)); };
  const double turned = last("stress_work_J") + last("kinetic_J") + last("drag_loss_J") + last("load_work_J") +
                        last("boundary_work_J") + last("potential_J");
  CHECK(turned > 1);
  CHECK(last("residual_J") < 0.02 * turned);
}
