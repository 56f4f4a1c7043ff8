// Scenes that mean nothing, or not what was meant, are refused with what to do about it.
#include <fstream>

#include "tests/catch.hpp"
#include "tests/child.hpp"
#include "tests/folder.hpp"
#include "tools/mpm/setup/setup.hpp"

using namespace mpm;
using Catch::Matchers::Contains;
using rvelab::test::Folder;

namespace {

/// Two layers in a box with a footing.
constexpr const char* layers = R"(
[scene]
name = "layers"
[grid]
cell_m = 0.25
[time]
duration_s = 1
[loads]
gravity_m_s2 = [0, -10]
[initial]
stress = "geostatic"
surface_m = 2
earth_pressure_ratio = 0.5
[[material]]
name = "clay"
kind = "elastic"
density_kg_m3 = 1500
young_modulus_Pa = 1e7
[[material]]
name = "sand"
kind = "mohr_coulomb"
density_kg_m3 = 2000
young_modulus_Pa = 2e7
[[region]]
material = "clay"
lower_m = [0, 0]
upper_m = [2, 1]
[[region]]
material = "sand"
lower_m = [0, 1]
upper_m = [1, 2]
[[boundary]]
name = "left"
kind = "roller"
axis = "x"
at_m = 0
[[boundary]]
name = "right"
kind = "roller"
axis = "x"
at_m = 2
soil = "below"
[[boundary]]
name = "bottom"
kind = "fixed"
axis = "y"
at_m = 0
[[boundary]]
name = "top"
kind = "roller"
axis = "y"
at_m = 3
soil = "below"
[[body]]
name = "footing"
kind = "box"
centre_m = [0.5, 2.25]
size_m = [0.5, 0.5]
[output]
watched_points_m = [[0.5, 0.5]]
)";

std::string refusal(const std::vector<std::string>& assignments, std::string text = layers,
                    const std::string& from = "", const std::string& to = "") {
  const Folder folder;
  if (!from.empty()) {
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
  }
  std::ofstream(folder / "scene.toml") << text;
  try {
    set_up<2>(read_scene(folder / "scene.toml", {}, assignments), 1, folder.path());
  } catch (const InputError& mistake) {
    return mistake.what();
  }
  return "accepted";
}

std::string edited(const std::string& from, const std::string& to) { return refusal({}, layers, from, to); }

}  // namespace

TEST_CASE("layers weigh what they weigh, each of its own soil") {
  const Folder folder;
  std::ofstream(folder / "scene.toml") << layers;
  const auto model = set_up<2>(read_scene(folder / "scene.toml", {}, {}), 1, folder.path());
  for (const auto& point : model->solver.points) {
    const double x = point.position[0], y = point.position[1];
    // Where no sand lies on it, clay carries its own weight up to the surface that was named.
    const double above = y > 1 ? 2000 * (2 - y) : (x < 1 ? 2000 : 1500) + 1500 * (1 - y);
    CHECK(point.stress(1, 1) == Approx(-10 * above));
    CHECK(point.stress(0, 0) == Approx(-5 * above));
  }
  CHECK_THAT(refusal({"initial.surface_m=1.5"}), Contains("region.1 (of sand) lie above initial.surface_m = 1.5"));
  CHECK_THAT(refusal({"loads.gravity_m_s2=[0, 0]"}), Contains("needs gravity down the last axis alone"));
  CHECK_THAT(refusal({"loads.gravity_m_s2=[1, -10]"}), Contains("initial.stress"));
}

TEST_CASE("soil behind a boundary is refused, unless the boundary is gone at the start") {
  CHECK_THAT(edited("at_m = 2\nsoil = \"below\"", "at_m = 2"),
             Contains("points of region.0 (of clay) lie behind boundary.right (soil above x = 2 m)") &&
                 Contains("set soil = \"below\" there, or move the region"));
  CHECK_THAT(edited("at_m = 3\nsoil", "at_m = 1.5\nsoil"), Contains("region.1 (of sand) lie behind boundary.top"));
  CHECK(edited("at_m = 3\nsoil", "at_m = 1.5\nremoved_at_s = 0\nsoil") == "accepted");
}

TEST_CASE("planes move as the grid does, or not at all") {
  const auto top = [](const std::string& motion, const std::string& more = "") {
    return refusal({"boundary.top.motion=" + motion, "grid.follows=top", more.empty() ? "time.cfl=0.4" : more});
  };
  CHECK(top("[[0, 0, -0.1]]") == "accepted");
  CHECK_THAT(refusal({"boundary.top.motion=[[0, 0, -0.1]]"}),
             Contains("boundary.motion moves the plane off its nodes") && Contains("set grid.follows = \"top\""));
  CHECK_THAT(top("[[0, 0.1, 0]]"), Contains("along a smooth plane") && Contains("set kind = \"fixed\""));
  CHECK(refusal({"boundary.bottom.motion=[[0, 0.1, 0]]"}) == "accepted");
  CHECK_THAT(top("[[0, 0, -0.1]]", "boundary.bottom.at_m=-0.25"),
             Contains("boundary.bottom.at_m is -0.25") && Contains("put it at 0"));
  // Down by 3.2 m and up again.
  CHECK_THAT(top("[[0, 0, -8], [0.4, 0, -8], [0.4001, 0, 8]]"), Contains("shorten motion or time.duration_s"));
  CHECK(top("[[0, 0, -8], [0.3, 0, -8], [0.3001, 0, 8]]") == "accepted");
}

TEST_CASE("numbers that are not finite, or too many points to hold, are refused") {
  for (const char* bad : {"loads.gravity_m_s2=[0, nan]", "grid.cell_m=inf", "grid.cell_m=[0.25, inf]",
                          "body.footing.motion=[[0, nan, 0]]", "region.0.velocity_m_s=[nan, 0]",
                          "region.1.upper_m=[1, inf]", "output.watched_points_m=[[0, inf]]"}) {
    CAPTURE(bad);
    CHECK_THAT(refusal({bad}), Contains("give numbers that are finite"));
  }
  CHECK_THAT(refusal({"region.0.lower_m=[-1e9, 0]"}), Contains("move it nearer, or make grid.cell_m larger"));
  CHECK_THAT(refusal({"region.1.upper_m=[1, 1e8]"}),
             Contains("region.1 (of sand) would have 6.4e+09 material points") && Contains("at most 5e+07"));
  CHECK_THAT(refusal({"grid.cell_m=1e-5"}), Contains("make grid.cell_m larger"));
  CHECK_THAT(refusal({"boundary.top.at_m=5e8"}), Contains("boundary.top.at_m is 5e+08"));
}

TEST_CASE("values without a meaning are refused where they stand") {
  CHECK_THAT(refusal({"time.duration_s=0"}), Contains("time.duration_s is 0; it must be positive"));
  CHECK_THAT(edited("duration_s = 1", "duration_s = -1"), Contains("scene.toml:7: time.duration_s is -1"));
  CHECK_THAT(refusal({"output.frame_every_s=1e-20"}), Contains("output.frame_every_s is 1e-20; allowed: 1e-06"));
  CHECK_THAT(refusal({"loads.gravity_m_s2=-10"}), Contains("must be 2 numbers in brackets, one for each axis"));
  CHECK_THAT(refusal({"body.footing.size_m=[0.5, -1]"}), Contains("body.size_m is -1; it must be positive"));
  CHECK_THAT(edited("kind = \"box\"", "kind = \"disc\"\nradius_m = -1"), Contains("body.radius_m is -1"));
  CHECK_THAT(edited("kind = \"box\"", "kind = \"half_space\"\nnormal = [0, 0]"), Contains("size_m"));
  CHECK_THAT(edited("kind = \"box\"\ncentre_m = [0.5, 2.25]\nsize_m = [0.5, 0.5]",
                    "kind = \"half_space\"\ncentre_m = [0, 0]\nnormal = [0, 0]"),
             Contains("body.normal is zero"));
  CHECK_THAT(
      refusal({"body.footing.centre_m=[0.5, 2.0]"}),
      Contains("region.1 (of sand): its point at [0.3125, 1.8125] m would lie inside body.footing at the start") &&
          Contains("set contact = \"nodes\" in body.footing"));
  CHECK(refusal({"body.footing.centre_m=[0.5, 2.0]", "body.footing.contact=nodes"}) == "accepted");
  CHECK_THAT(refusal({"body.footing.friction=0.3"}), Contains("set rough = false"));
  CHECK_THAT(refusal({"body.footing.frction=0.3"}), Contains("the nearest known key is body.friction"));
  CHECK_THAT(refusal({"material.sand.hardening=cubic_exponential", "material.sand.cubic_rad=0.1"}),
             Contains("material.cubic_rad must be 4 numbers in brackets") && !Contains("axis"));
  const std::vector<std::string> hardening{"material.sand.hardening=cubic_exponential",
                                           "material.sand.cubic_rad=[0, 0, 0, 0.5]"};
  const auto with = [&](const std::string& peak, const std::string& decay) {
    auto all = hardening;
    all.insert(all.end(), {"material.sand.peak_plastic_strain=" + peak, "material.sand.decay=" + decay});
    return refusal(all);
  };
  CHECK(with("0.02", "50") == "accepted");
  CHECK_THAT(with("0", "50"), Contains("peak_plastic_strain is 0; it must be positive"));
  CHECK_THAT(with("0.02", "-1"), Contains("decay must not be negative"));
}

TEST_CASE("loads that would strain the soil by half at once are refused, with the bound") {
  CHECK_THAT(refusal({"loads.gravity_m_s2=[0, -1e9]"}),
             Contains("loads.gravity_m_s2 = [0, -1e+09]: a pressure of 3e+12 Pa would compress material clay") &&
                 Contains("allowed: up to 6.73077e+06 Pa; make the load smaller, or the material stiffer"));
  CHECK_THAT(refusal({"material.sand.young_modulus_Pa=1e3"}), Contains("would compress material sand"));
  CHECK_THAT(refusal({"loads.surface_pressure_Pa=-1e8"}), Contains("loads.surface_pressure_Pa = -1e+08"));
  CHECK_THAT(refusal({"initial={stress=\"isotropic\", pressure_Pa=1e8}"}), Contains("initial.pressure_Pa = 1e+08"));
  CHECK_THAT(
      refusal({"region.1.velocity_m_s=[0, 90]"}),
      Contains("region.1 (of sand).velocity_m_s: against region.0 (of clay).velocity_m_s it moves at up to 90 m/s"));
  // Waves of clay: 94.7 m/s.
  CHECK_THAT(refusal({"body.footing.motion=[[0, 0, 0], [1, 0, -50]]"}),
             Contains("body.footing.motion: against region.0 (of clay).velocity_m_s it moves at up to 50 m/s") &&
                 Contains("make it slower, or the material stiffer"));
  CHECK(refusal({"body.footing.motion=[[0, 0, 0], [1, 0, -45]]"}) == "accepted");
  CHECK(refusal({"loads.gravity_m_s2=[0, -1e3]"}) == "accepted");
}

TEST_CASE("names are told apart, regions share no place, and watched points lie at soil") {
  CHECK_THAT(refusal({"boundary.right.name=left"}), Contains("two boundaries, bodies or rocks are called left"));
  CHECK_THAT(refusal({"body.footing.name=left"}), Contains("two boundaries, bodies or rocks are called left"));
  CHECK_THAT(refusal({"material.clay.name=\"clay/2\""}),
             Contains("is \"clay/2\"") && Contains("letters, digits, _ and -"));
  CHECK_THAT(refusal({"region.1.lower_m=[0, 0.9]"}), Contains("region.0 (of clay) and region.1 (of sand) overlap"));
  CHECK_THAT(refusal({"output.watched_points_m=[[0.5, 0.5], [1.4, 1.4]]"}),
             Contains("output.watched_points_m[1] is [1.4, 1.4]") && Contains("move it into a region"));
  CHECK(refusal({"output.watched_points_m=[[0.5, 2.1]]"}) == "accepted");
}

TEST_CASE("a misspelt key is told before the one that it should have been, and all of a table at once") {
  CHECK_THAT(edited("duration_s = 1", "duraton_s = 1\nclf = 0.2"),
             Contains("unknown key time.clf; the nearest known key is time.cfl") &&
                 Contains("unknown too: time.duraton_s (time.duration_s)"));
  CHECK_THAT(edited("[time]", "[tme]"), Contains("unknown key tme; the nearest known key is time"));
  CHECK_THAT(edited("duration_s = 1", ""), Contains("time.duration_s is missing"));
  CHECK_THAT(edited("kind = \"elastic\"", "knd = \"elastic\""), Contains("unknown key material.knd"));
  CHECK_THAT(edited("kind = \"elastic\"", ""), Contains("material.kind is missing; allowed: grains"));
  CHECK_THAT(edited("lower_m = [0, 0]", ""), Contains("region.lower_m is missing"));
}

TEST_CASE("assignments reach tables without a name by number, and say what is missing in them") {
  CHECK(refusal({"region.0.points_per_cell=9"}) == "accepted");
  CHECK_THAT(refusal({"region.0.points_per_cell=5"}), Contains("must be a square"));
  CHECK_THAT(refusal({"region.points_per_cell=9"}), Contains("give region.0.key=value or region.1.key=value"));
  CHECK_THAT(refusal({"boundary.lft.at_m=0"}), Contains("give boundary.left.key=value or boundary.right.key=value"));
  for (const char* bad : {"=5", ".=5", "time.=5", ".duration_s=5", "time..duration_s=5"}) {
    CAPTURE(bad);
    CHECK_THAT(refusal({bad}), Contains("name missing before the =; give it as table.key=value"));
  }
  CHECK_THAT(refusal({"grid.cell_m.0=1"}), Contains("cell_m is no table"));
}
