// Scenes that mean nothing, or not what was meant, are refused with what to do about it.
#include "tests/mpm/scenes.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

/// Two layers in a box with a footing.
const std::string layers = head("layers", "0.25", "1") + "[loads]\ngravity_m_s2 = [0, -10]\n" +
                           "[initial]\nstress = \"geostatic\"\nsurface_m = 2\nearth_pressure_ratio = 0.5\n" +
                           soil_of("clay", "elastic", "1500", "1e7") + soil_of("sand", "mohr_coulomb", "2000", "2e7") +
                           region("clay", "[0, 0]", "[2, 1]") + region("sand", "[0, 1]", "[1, 2]") +
                           boundary("left", "roller", "x", "0") + boundary("right", "roller", "x", "2", below) +
                           boundary("bottom", "fixed", "y", "0") + boundary("top", "roller", "y", "3", below) +
                           box_body("footing", "[0.5, 2.25]", "[0.5, 0.5]") +
                           "[output]\nwatched_points_m = [[0.5, 0.5]]\n";

}  // namespace

TEST_CASE("layers weigh what they weigh, each of its own soil") {
  const auto model = model_of<2>(layers);
  for (const auto& point : model->solver.points) {
    const double x = point.position[0], y = point.position[1];
    // Where no sand lies on it, clay carries its own weight up to the surface that was named.
    const double above = y > 1 ? 2000 * (2 - y) : (x < 1 ? 2000 : 1500) + 1500 * (1 - y);
    CHECK(point.stress(1, 1) == Approx(-10 * above));
    CHECK(point.stress(0, 0) == Approx(-5 * above));
  }
  expect_said(layers, {{set("initial.surface_m=1.5"), {"region.1 (of sand)", "initial.surface_m = 1.5"}},
                       {set("loads.gravity_m_s2=[0, 0]"), {"initial.stress", "gravity down the last axis alone"}},
                       {set("loads.gravity_m_s2=[1, -10]"), {"initial.stress"}}});
}

TEST_CASE("soil behind a boundary is refused, unless the boundary is gone at the start") {
  expect_said(layers, {{edit("at_m = 2\nsoil = \"below\"", "at_m = 2"),
                        {"region.0 (of clay)", "boundary.right (soil above x = 2 m)", "set soil = \"below\""}},
                       {edit("at_m = 3\nsoil", "at_m = 1.5\nsoil"), {"region.1 (of sand)", "boundary.top"}},
                       {edit("at_m = 3\nsoil", "at_m = 1.5\nremoved_at_s = 0\nsoil"), {"accepted"}}});
}

TEST_CASE("planes move as the grid does, or not at all") {
  const auto top = [](const std::string& motion, const std::string& more = "time.cfl=0.4") {
    return set({"boundary.top.motion=" + motion, "grid.follows=top", more});
  };
  expect_said(layers,
              {{top("[[0, 0, -0.1]]"), {"accepted"}},
               {set("boundary.top.motion=[[0, 0, -0.1]]"), {"boundary.motion", "set grid.follows = \"top\""}},
               {top("[[0, 0.1, 0]]"), {"along a smooth plane", "set kind = \"fixed\""}},
               {set("boundary.bottom.motion=[[0, 0.1, 0]]"), {"accepted"}},
               {top("[[0, 0, -0.1]]", "boundary.bottom.at_m=-0.25"), {"boundary.bottom.at_m", "-0.25", "put it at 0"}},
               // Down by 3.2 m and up again.
               {top("[[0, 0, -8], [0.4, 0, -8], [0.4001, 0, 8]]"), {"shorten motion or time.duration_s"}},
               {top("[[0, 0, -8], [0.3, 0, -8], [0.3001, 0, 8]]"), {"accepted"}}});
}

TEST_CASE("numbers that are not finite, or too many points to hold, are refused") {
  for (const char* bad : {"loads.gravity_m_s2=[0, nan]", "grid.cell_m=inf", "grid.cell_m=[0.25, inf]",
                          "body.footing.motion=[[0, nan, 0]]", "region.0.velocity_m_s=[nan, 0]",
                          "region.1.upper_m=[1, inf]", "output.watched_points_m=[[0, inf]]"}) {
    expect_said(layers, {{set(bad), {"give a finite number"}}});
  }
  expect_said(layers, {{set("region.0.lower_m=[-1e9, 0]"), {"region.0", "move it nearer"}},
                       {set("region.1.upper_m=[1, 1e8]"), {"region.1 (of sand)", "6.4e+09", "at most 5e+07"}},
                       {set("grid.cell_m=1e-5"), {"make grid.cell_m larger"}},
                       {set("boundary.top.at_m=5e8"), {"boundary.top.at_m", "5e+08"}}});
}

TEST_CASE("values without a meaning are refused where they stand") {
  const auto hardening = [](const std::string& peak, const std::string& decay, const std::string& cubic) {
    return set({"material.sand.hardening=cubic_exponential", "material.sand.cubic_rad=" + cubic,
                "material.sand.peak_plastic_strain=" + peak, "material.sand.decay=" + decay});
  };
  const std::string cubic = "[0, 0, 0, 0.5]";
  expect_said(layers, {{set("time.duration_s=0"), {"time.duration_s = 0", "range"}},
                       {edit("duration_s = 1", "duration_s = -1"), {"scene.toml:7: time.duration_s = -1"}},
                       {set("output.frame_every_s=1e-20"), {"output.frame_every_s = 1e-20", "allowed: 1e-06"}},
                       {set("loads.gravity_m_s2=-10"), {"loads.gravity_m_s2", "list of numbers"}},
                       {set("loads.gravity_m_s2=[-10]"), {"loads.gravity_m_s2", "2 numbers in brackets"}},
                       {set("body.footing.size_m=[0.5, -1]"), {"body.size_m", "-1", "range"}},
                       {edit("kind = \"box\"", "kind = \"disc\"\nradius_m = -1"), {"body.radius_m = -1"}},
                       {edit("kind = \"box\"", "kind = \"half_space\"\nnormal = [0, 0]"), {"size_m"}},
                       {edit("kind = \"box\"\ncentre_m = [0.5, 2.25]\nsize_m = [0.5, 0.5]",
                             "kind = \"half_space\"\ncentre_m = [0, 0]\nnormal = [0, 0]"),
                        {"body.normal is zero"}},
                       {set("body.footing.centre_m=[0.5, 2.0]"),
                        {"region.1 (of sand)", "[0.3125, 1.8125] m", "set contact = \"nodes\" in body.footing"}},
                       {set({"body.footing.centre_m=[0.5, 2.0]", "body.footing.contact=nodes"}), {"accepted"}},
                       {set("body.footing.friction=0.3"), {"set rough = false"}},
                       {set("body.footing.frction=0.3"), {"nearest known key is body.friction"}},
                       {hardening("0.02", "50", "0.1"), {"material.cubic_rad", "list of numbers"}},
                       {hardening("0.02", "50", "[0.1]"), {"material.cubic_rad", "4 numbers in brackets"}},
                       {hardening("0.02", "50", cubic), {"accepted"}},
                       {hardening("0", "50", cubic), {"peak_plastic_strain = 0", "range"}},
                       {hardening("0.02", "-1", cubic), {"decay must not be negative"}}});
}

TEST_CASE("loads that would strain the soil by half at once are refused, with the bound") {
  expect_said(layers, {{set("loads.gravity_m_s2=[0, -1e9]"),
                        {"loads.gravity_m_s2 = [0, -1e+09]", "3e+12 Pa", "material clay", "up to 6.73077e+06 Pa"}},
                       {set("material.sand.young_modulus_Pa=1e3"), {"material sand"}},
                       {set("loads.surface_pressure_Pa=-1e8"), {"loads.surface_pressure_Pa = -1e+08"}},
                       {set("initial={stress=\"isotropic\", pressure_Pa=1e8}"), {"initial.pressure_Pa = 1e+08"}},
                       {set("region.1.velocity_m_s=[0, 90]"),
                        {"region.1 (of sand).velocity_m_s", "region.0 (of clay).velocity_m_s", "90 m/s"}},
                       // Waves of clay: 94.7 m/s.
                       {set("body.footing.motion=[[0, 0, 0], [1, 0, -50]]"),
                        {"body.footing.motion", "region.0 (of clay).velocity_m_s", "50 m/s", "make it slower"}},
                       {set("body.footing.motion=[[0, 0, 0], [1, 0, -45]]"), {"accepted"}},
                       {set("loads.gravity_m_s2=[0, -1e3]"), {"accepted"}}});
}

TEST_CASE("names are told apart, regions share no place, and watched points lie at soil") {
  expect_said(layers, {{set("boundary.right.name=left"), {"two boundaries, bodies or rocks are called left"}},
                       {set("body.footing.name=left"), {"two boundaries, bodies or rocks are called left"}},
                       {set("material.clay.name=\"clay/2\""), {"\"clay/2\"", "letters, digits, _ and -"}},
                       {set("region.1.lower_m=[0, 0.9]"), {"region.0 (of clay)", "region.1 (of sand)", "overlap"}},
                       {set("output.watched_points_m=[[0.5, 0.5], [1.4, 1.4]]"),
                        {"output.watched_points_m[1]", "[1.4, 1.4]", "move it into a region"}},
                       {set("output.watched_points_m=[[0.5, 2.1]]"), {"accepted"}}});
}

TEST_CASE("a misspelt key is told beside the one that it should have been, and all of a table at once") {
  expect_said(layers, {{edit("duration_s = 1", "duraton_s = 1\nclf = 0.2"),
                        {"unknown key time.clf; the nearest known key is time.cfl",
                         "unknown key time.duraton_s; the nearest known key is time.duration_s"}},
                       {edit("[time]", "[tme]"), {"unknown key tme; the nearest known key is time"}},
                       {edit("duration_s = 1", ""), {"time.duration_s is missing"}},
                       {edit("kind = \"elastic\"", "knd = \"elastic\""), {"unknown key material.knd", "material.kind"}},
                       {edit("kind = \"elastic\"", ""), {"material.kind is missing; allowed: grains"}},
                       {edit("lower_m = [0, 0]", ""), {"region.lower_m is missing"}},
                       {edit("density_kg_m3 = 1500", "density_g_cm3 = 1.5"), {"material.density_kg_m3", "1 g/cm^3"}}});
}

TEST_CASE("assignments reach tables without a name by number, and say what is missing in them") {
  expect_said(layers, {{set("region.0.points_per_cell=9"), {"accepted"}},
                       {set("region.0.points_per_cell=5"), {"must be a square"}},
                       {set("region.points_per_cell=9"), {"--set region.points_per_cell=9", "allowed: 0, 1"}},
                       {set("boundary.lft.at_m=0"), {"--set boundary.lft.at_m=0", "0 (left), 1 (right)"}},
                       {set("grid.cell_m.0=1"), {"cell_m is no table"}}});
  for (const char* bad : {"=5", ".=5", "time.=5", ".duration_s=5", "time..duration_s=5", "time.duration_s="})
    expect_said(layers, {{set(bad), {"is not an assignment", "table.key=value"}}});
}
