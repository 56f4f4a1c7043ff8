// Saturated scenes: what is refused, and with which remedy; runs that are stopped, resumed, spread over threads.
#include <filesystem>
#include <fstream>

#include "tests/mpm/scene_runs.hpp"
#include "tools/mpm/setup/setup.hpp"

using namespace mpm;
using Catch::Matchers::Contains;
using rvelab::test::bytes_of;
using rvelab::test::Folder;

namespace {

/// A saturated layer under a dry one, shaken, loaded on a strip, with water at a head on the right.
constexpr const char* shaken = R"(
[scene]
name = "shaken"
[grid]
cell_m = 0.25
[time]
duration_s = 0.05
[loads]
gravity_m_s2 = [0, -9.81]
shaking = { axis = "x", velocity_m_s = 0.05, frequency_Hz = 5 }
strip = [{ lower_m = 0, upper_m = 0.5, history = [[0, 0], [0.01, 1e3]] }]
[initial]
stress = "geostatic"
surface_m = 1.5
[fluid]
conductivity_m_s = 1e-3
porosity = 0.3
water_table_m = 1
[[material]]
name = "sand"
kind = "mohr_coulomb"
density_kg_m3 = 1855
young_modulus_Pa = 1e7
[[region]]
material = "sand"
lower_m = [0, 0]
upper_m = [2, 1]
[[region]]
material = "sand"
lower_m = [0, 1]
upper_m = [2, 1.5]
saturated = false
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
head_m = 1
[[boundary]]
name = "base"
kind = "fixed"
axis = "y"
at_m = 0
[[body]]
name = "footing"
kind = "box"
centre_m = [1, 1.75]
size_m = [0.5, 0.5]
motion = [[0, 0, -0.05]]
[output]
watched_points_m = [[0.5, 0.5]]
)";

std::string refusal(const std::string& from, const std::string& to, const std::vector<std::string>& assignments = {}) {
  const Folder folder;
  std::string text = shaken;
  if (!from.empty()) {
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
  }
  std::ofstream(folder / "scene.toml") << text;
  std::ofstream(folder / "good.csv") << "time,acceleration\n0,0\n0.1,1.5\n0.2,0\n";
  std::ofstream(folder / "bad.csv") << "0,0\n0.1,much\n";
  try {
    const auto model = set_up<2>(read_scene(folder / "scene.toml", {}, assignments), 1, folder.path());
    model->solver.step(model->solver.stable_step());
  } catch (const InputError& mistake) {
    return mistake.what();
  }
  return "accepted";
}

std::string set(const std::string& assignment) { return refusal("", "", {assignment}); }

}  // namespace

TEST_CASE("Keys of saturated soil that are wrong are refused, with the key and the remedy") {
  CHECK(refusal("", "") == "accepted");
  CHECK_THAT(set("fluid.conductivity_m_s=0"), Contains("fluid.conductivity_m_s is 0; it must be positive"));
  CHECK_THAT(refusal("conductivity_m_s = 1e-3\n", ""), Contains("the key fluid.conductivity_m_s is missing"));
  CHECK_THAT(set("fluid.conductivty_m_s=1"), Contains("nearest known key is fluid.conductivity_m_s"));
  CHECK_THAT(set("fluid.bulk_modulus_Pa=-1"), Contains("fluid.bulk_modulus_Pa is -1; it must be positive"));
  CHECK_THAT(set("fluid.density_kg_m3=0"), Contains("fluid.density_kg_m3 is 0; allowed"));
  CHECK_THAT(set("fluid.porosity=1.5"), Contains("fluid.porosity is 1.5; allowed"));
  CHECK_THAT(refusal("porosity = 0.3\n", ""), Contains("set fluid.porosity or its porosity"));
  CHECK_THAT(set("fluid.free_surface=open"), Contains("allowed: drained, membrane"));
  CHECK_THAT(set("fluid.water_table_m=0.5"),
             Contains("above fluid.water_table_m = 0.5") && Contains("saturated = false"));
  CHECK_THAT(set("fluid.water_table_m=2"), Contains("lies above initial.surface_m = 1.5"));
  CHECK_THAT(set("region.0.saturated=false"), Contains("set saturated = true in one"));
  CHECK_THAT(set("region.0.porosity=0"), Contains("region.porosity is 0; allowed"));
  CHECK_THAT(set("region.0.points_per_cell=1"), Contains("points_per_cell is 1") && Contains("fewer than 4"));
  CHECK_THAT(set("time.scheme=musl"), Contains("set time.scheme = \"usf\""));
  CHECK_THAT(refusal("head_m = 1\n", "head_m = 1\ndrained = true\n"), Contains("say the same thing twice"));
  CHECK_THAT(refusal("head_m = 1\n", "head_m = \"up\"\n"), Contains("boundary.head_m must be a number"));
  CHECK_THAT(refusal("[fluid]\nconductivity_m_s = 1e-3\nporosity = 0.3\nwater_table_m = 1\n", ""),
             Contains("the scene has no [fluid]; add it, or remove the key"));
  CHECK_THAT(set("loads.gravity_m_s2=[0, 0]"), Contains("needs gravity"));
  CHECK_THAT(set("fluid.follows_void_ratio=1"), Contains("fluid.follows_void_ratio must be true or false"));
}

TEST_CASE("Loads in time that are wrong are refused, with the key and the remedy") {
  const std::string harmonic = "shaking = { axis = \"x\", velocity_m_s = 0.05, frequency_Hz = 5 }";
  const auto shaking = [&](const std::string& to) { return refusal(harmonic, "shaking = { " + to + " }"); };
  CHECK(shaking("record_csv = \"good.csv\"") == "accepted");
  CHECK_THAT(shaking("record_csv = \"bad.csv\""), Contains("bad.csv:2: is no row of a time in s"));
  CHECK_THAT(shaking("record_csv = \"none.csv\""), Contains("names a file beside the scene"));
  CHECK_THAT(shaking("record = [[0, 1], [0, 2]]"), Contains("must go forward in time"));
  CHECK_THAT(shaking("record = [[0, 1], [1, 2]], frequency_Hz = 2"), Contains("is of harmonic shaking"));
  CHECK_THAT(shaking("velocity_m_s = 1"), Contains("loads.shaking.frequency_Hz is missing"));
  CHECK_THAT(shaking("velocity_m_s = 1, frequency_Hz = 0"), Contains("it must be positive"));
  CHECK_THAT(shaking("axis = \"z\", velocity_m_s = 1, frequency_Hz = 1"), Contains("allowed: x, y"));
  CHECK_THAT(refusal("upper_m = 0.5, history", "upper_m = -0.5, history"), Contains("strip.upper_m must be above"));
  CHECK_THAT(refusal(", history = [[0, 0], [0.01, 1e3]]", ""), Contains("give rows [s, Pa], or a pulse"));
}

TEST_CASE("Absorbing and periodic boundaries that are wrong are refused, with the key and the remedy") {
  const std::string base = "kind = \"fixed\"\naxis = \"y\"\nat_m = 0\n";
  const auto at_base = [&](const std::string& to) { return refusal(base, to + "axis = \"y\"\nat_m = 0\n"); };
  const std::string absorbing = "kind = \"absorbing\"\ndensity_kg_m3 = 2600\n";
  CHECK(at_base(absorbing + "shear_wave_m_s = 500\n") == "accepted");
  CHECK(at_base(absorbing + "shear_wave_m_s = 500\nmotion = [[0, 0, 0], [0.01, 0.1, 0]]\n") == "accepted");
  CHECK_THAT(at_base(absorbing), Contains("the key boundary.shear_wave_m_s is missing"));
  CHECK_THAT(at_base(absorbing + "shear_wave_m_s = -1\n"), Contains("it must be positive"));
  CHECK_THAT(at_base(absorbing + "shear_wave_m_s = 500\nmotion = [[0, 0, 0.1]]\n"),
             Contains("boundary.motion is the shear wave that comes up: along the plane"));
  const std::string left = "name = \"left\"\nkind = \"roller\"\naxis = \"x\"\nat_m = 0\n";
  const auto at_left = [&](const std::string& to) {
    return refusal(left, "name = \"left\"\nkind = \"periodic\"\naxis = \"x\"\nat_m = 0\n" + to);
  };
  CHECK_THAT(at_left(""), Contains("the key boundary.to_m is missing"));
  CHECK_THAT(at_left("to_m = -1\n"), Contains("boundary.to_m is the upper of two planes"));
  CHECK_THAT(at_left("to_m = 1.9\n"), Contains("lie beyond boundary.left.to_m = 1.9"));
  CHECK_THAT(at_left("to_m = 2.1\n"), Contains("to_m must be a whole number of cells"));
}

TEST_CASE("Water that is enclosed and cannot be compressed is refused for want of a datum") {
  const std::string lid =
      "[[boundary]]\nname = \"lid\"\nkind = \"roller\"\naxis = \"y\"\nat_m = 1.5\nsoil = \"below\"\n[output]";
  std::string closed = shaken;
  const auto replace = [&](const std::string& from, const std::string& to) {
    closed.replace(closed.find(from), from.size(), to);
  };
  replace("head_m = 1\n", "");
  replace("[output]", lid);
  replace("saturated = false\n", "");
  replace("water_table_m = 1\n", "");
  closed.erase(closed.find("[[body]]"), closed.find("[[boundary]]\nname = \"lid\"") - closed.find("[[body]]"));
  const Folder folder;
  std::ofstream(folder / "scene.toml") << closed;
  const auto step = [&](const std::vector<std::string>& more) {
    const auto model = set_up<2>(read_scene(folder / "scene.toml", {}, more), 1, folder.path());
    model->solver.step(model->solver.stable_step());
  };
  CHECK_THROWS_WITH(step({}), Contains("its pressure has no datum") && Contains("fluid.bulk_modulus_Pa"));
  CHECK_NOTHROW(step({"fluid.bulk_modulus_Pa=2e9"}));
}

TEST_CASE("A saturated run that was stopped goes on with the same bytes, over any number of threads") {
  const test::SceneRuns bench(shaken);
  REQUIRE(bench.start("a", {"-q", "-j", "1"}) == 0);
  REQUIRE(bench.start("b", {"-q", "-j", "3", "--stop-at", "0.02"}) == 0);
  REQUIRE(bench.run({"--resume", bench.folder / "b", "-q", "-j", "2"}) == 0);
  bench.expect_same("a", "b", 24);
}

TEST_CASE("Energy of a shaken, loaded, saturated scene is accounted for, drained and undrained") {
  const test::SceneRuns bench(shaken);
  const std::string conductivity = GENERATE("1e-3", "1e-9");
  CAPTURE(conductivity);
  REQUIRE(bench.start("a", {"-q", "-j", "1", "--set", "fluid.conductivity_m_s=" + conductivity}) == 0);
  const auto text = bytes_of(bench.folder / "a/history.csv");
  const auto split = [](std::string line) {
    std::vector<std::string> words;
    std::istringstream stream(line);
    for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
    return words;
  };
  const auto names = split(text.substr(0, text.find('\n')));
  const auto last = split(text.substr(text.rfind('\n', text.size() - 2) + 1));
  REQUIRE(names.size() == last.size());
  std::map<std::string, double> h;
  for (std::size_t k = 0; k < names.size(); ++k) h[names[k]] = std::stod(last[k]);
  const double turned = std::abs(h["stress_work_J"]) + h["kinetic_J"] + h["drag_loss_J"] + std::abs(h["load_work_J"]) +
                        std::abs(h["boundary_work_J"]) + std::abs(h["potential_J"]);
  CHECK(turned > 1);
  CHECK(std::abs(h["residual_J"]) < 0.02 * turned);
}
