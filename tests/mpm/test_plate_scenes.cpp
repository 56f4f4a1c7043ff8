// Plates under pressure in scenes: stress of soil and rocks, areas and masses, the end of the pressure, runs that are
// stopped and resumed.
#include <algorithm>
#include <sstream>

#include "tests/mpm/plates.hpp"
#include "tests/mpm/rock_refusals.hpp"
#include "tests/mpm/scene_runs.hpp"

using namespace mpm;
using namespace mpm::test;
using Catch::Matchers::Contains;
using rvelab::test::bytes_of;
using rvelab::test::Folder;

namespace {

/// A cube of soil between three rollers and three plates, with a rock in its middle.
constexpr const char* pressed_cube = R"(
[scene]
name = "pressed"
dimension = 3
[grid]
cell_m = 0.1
[time]
duration_s = 0.03
[initial]
stress = "isotropic"
pressure_Pa = 2e4
[[material]]
name = "soil"
kind = "elastic"
density_kg_m3 = 2000
young_modulus_Pa = 1e7
poisson_ratio = 0.25
[[region]]
material = "soil"
lower_m = [0, 0, 0]
upper_m = [0.6, 0.6, 0.6]
[[boundary]]
name = "left"
kind = "roller"
axis = "x"
at_m = 0
[[boundary]]
name = "front"
kind = "roller"
axis = "y"
at_m = 0
[[boundary]]
name = "bottom"
kind = "roller"
axis = "z"
at_m = 0
[[body]]
name = "right"
kind = "half_space"
centre_m = [0.6, 0, 0]
normal = [-1, 0, 0]
pressure_Pa = 2e4
[[body]]
name = "back"
kind = "half_space"
centre_m = [0, 0.6, 0]
normal = [0, -1, 0]
pressure_Pa = 2e4
[[body]]
name = "top"
kind = "half_space"
centre_m = [0, 0, 0.6]
normal = [0, 0, -1]
pressure_Pa = 2e4
[[rock_material]]
name = "basalt"
density_kg_m3 = 2700
young_modulus_Pa = 1e8
[[rock]]
name = "stone"
material = "basalt"
radius_m = 0.16
centre_m = [0.3, 0.3, 0.3]
[rock_soil]
rough = true
[output]
history_every_s = 0.001
frame_every_s = 0.006
checkpoint_every_s = 0.006
)";

template <int D>
std::unique_ptr<Model<D>> plates_of(const std::string& text, const std::vector<std::string>& assignments = {}) {
  const Folder folder;
  std::ofstream(folder / "scene.toml") << text;
  return set_up<D>(read_scene(folder / "scene.toml", {}, assignments), 1, folder.path());
}

/// The columns of a history.
struct History {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  explicit History(const std::string& path) {
    std::istringstream text(bytes_of(path));
    std::string line, cell;
    std::getline(text, line);
    for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell);
    while (std::getline(text, line)) {
      rows.emplace_back();
      for (std::istringstream row(line); std::getline(row, cell, ',');) rows.back().push_back(std::stod(cell));
    }
  }
  double at(std::size_t row, const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw std::runtime_error("no column " + name);
    return rows.at(row).at(std::size_t(found - names.begin()));
  }
};

}  // namespace

TEST_CASE("the mean stress of soil and a rock in it is that of the plates around them") {
  constexpr double p = 2e4;
  const auto model = plates_of<3>(pressed_cube, {"time.pic_fraction=1"});
  auto& solver = model->solver;
  const auto& rocks = *solver.rocks;
  Mat<3> sum = Mat<3>::Zero(), of_rock = Mat<3>::Zero();
  double volume = 0, soil_volume = 0;
  long samples = 0;
  while (solver.time < 0.04) {
    solver.step(solver.stable_step());
    if (solver.time < 0.02) continue;
    ++samples;
    for (const auto& point : solver.points) {
      sum += point.volume * point.stress;
      soil_volume += point.volume;
    }
    // The stress of a body in balance: sum of x f over its surface.
    const auto& places = solver.rocks->outline(rocks.all[0].shape, 1);
    REQUIRE(places.size() == rocks.pressed[0].size());
    for (std::size_t k = 0; k < places.size(); ++k) of_rock -= places[k].at * rocks.pressed[0][k].transpose();
    double box = 1;
    for (const auto& body : solver.bodies.all) box *= 0.6 - body.plate->displacement;
    volume += box;
  }
  CAPTURE(samples, soil_volume / volume, sum.trace() / volume / 3, of_rock.trace() / volume / 3);
  const Mat<3> mean = (sum + of_rock) / volume;
  CHECK((mean + p * Mat<3>::Identity()).cwiseAbs().maxCoeff() < 0.005 * p);
  CHECK(-of_rock.trace() / 3 / (p * double(samples)) > 0.5 * rocks.shapes[0].volume());  // the rock has its part
}

TEST_CASE("plates of a scene: areas between rollers, half-spaces and periodic sides, and masses of a cell of soil") {
  const auto plane = plates_of<2>(pressed_block);
  const auto& lid = *plane->solver.bodies.all[0].plate;
  CHECK(lid.area == Approx(2 * 0.4).epsilon(1e-14));
  CHECK(lid.mass == Approx(2000 * 0.8 * 0.1).epsilon(1e-12));
  const auto given = plates_of<2>(pressed_block, {"body.lid.area_m2=0.7", "body.lid.plate_mass_kg=5"});
  CHECK(given->solver.bodies.all[0].plate->area == 0.7);
  CHECK(given->solver.bodies.all[0].plate->mass == 5);
  const auto cube = plates_of<3>(pressed_cube);
  for (const auto& body : cube->solver.bodies.all) CHECK(body.plate->area == Approx(0.36).epsilon(1e-14));
  auto round = pressed_block;
  const auto from = round.find("[[boundary]]"), to = round.find("[[boundary]]\nname = \"bottom\"");
  round.replace(from, to - from,
                "[[boundary]]\nname = \"sides\"\nkind = \"periodic\"\naxis = \"x\"\nat_m = 0\nto_m = 0.4\n");
  CHECK(plates_of<2>(round)->solver.bodies.all[0].plate->area == Approx(0.8).epsilon(1e-14));
}

TEST_CASE("a plate whose pressure ends keeps its place, and then has its motion") {
  Solver<2> solver(1);
  solver.bodies.all = {plate_over<2>(1, 1, 1000, 5, 0.5)};
  auto& body = solver.bodies.all[0];
  body.plate->until = 0.0105;  // within the step from 0.010 to 0.011 s
  body.velocity.times = {0, 0.02, 0.03};
  body.velocity.velocities = {Vec<2>(0, 0), Vec<2>(0, 0), Vec<2>(0, -0.4)};
  const double a = 1000 * 0.5 / 5, gone = 0.5 * a * 0.011 * 0.011;
  for (int step = 0; step < 11; ++step) solver.step(1e-3);
  CHECK(body.displacement_at(solver.time)[1] == Approx(-gone).epsilon(1e-12));
  for (int step = 0; step < 8; ++step) {
    solver.step(1e-3);
    CHECK_FALSE(body.pressed());
    CHECK(body.velocity_at(solver.time).norm() < 1e-15);
    CHECK(body.centre_at(solver.time)[1] == Approx(1 - gone).epsilon(1e-12));
  }
  for (int step = 0; step < 21; ++step) solver.step(1e-3);
  CHECK(body.velocity_at(solver.time)[1] == -0.4);
  CHECK(body.displacement_at(solver.time)[1] == Approx(-gone - 0.002 - 0.4 * 0.01).epsilon(1e-12));
}

TEST_CASE("pressed soil and a rock leave the same bytes by any number of threads, and stopped and resumed") {
  const SceneRuns bench(pressed_cube);
  // From a larger pressure than that of the soil, so that all moves; the top is under way from 10 ms on.
  const std::vector<std::string> set{"--set", "body.top.pressure_until_s=0.01",
                                     "--set", "body.top.motion=[[0, 0, 0, 0], [0.012, 0, 0, 0], [0.013, 0, 0, -0.2]]",
                                     "--set", "body.right.pressure_Pa=3e4",
                                     "--set", "time.duration_s=0.02"};
  const auto start = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.end(), set.begin(), set.end());
    return bench.start(name, more);
  };
  REQUIRE(start("one", {"-j", "1"}) == 0);
  REQUIRE(start("three", {"-j", "3"}) == 0);
  bench.expect_same("one", "three", 10);
  for (const char* stop : {"0.0043", "0.0111", "0.0155"}) {  // pressed, held, under way
    const std::string name = "stopped_" + std::string(stop);
    REQUIRE(start(name, {"-j", "1", "--stop-at", stop}) == 0);
    REQUIRE(bench.run({"--resume", bench.folder / name, "-j", "3"}) == 0);
    bench.expect_same("one", name, 10);
  }
  const History history(bench.folder / "one/history.csv");
  double held = NAN;
  for (std::size_t k = 0; k < history.rows.size(); ++k) {
    const double t = history.at(k, "time_s"), z = history.at(k, "top.displacement_z_m");
    CHECK(history.at(k, "top.displacement_x_m") == 0);
    CHECK(history.at(k, "right.displacement_z_m") == 0);
    if (t > 0.0103 && std::isnan(held)) held = z;
    CAPTURE(t, z, held);
    if (t > 0.0103 && t < 0.012) CHECK(z == held);
    // A ramp of a millisecond to 0.2 m/s, then on with that.
    if (t > 0.013) CHECK(z - held == Approx(-0.2 * (t - 0.0125)).epsilon(1e-6));
  }
  const std::size_t last = history.rows.size() - 1;
  CHECK(held != 0);
  CHECK(history.at(last, "time_s") > 0.019);
  CHECK(history.at(last, "right.displacement_x_m") < 0);  // pressed in
  CHECK(history.at(last, "top.force_z_N") > 2e4 * 0.36);  // squeezed
}

TEST_CASE("the program refuses a plate that is none with status 2") {
  const SceneRuns bench(pressed_block);
  CHECK(bench.start("a", {"--set", "body.lid.pressure_Pa=-1"}) == 2);
  CHECK_THAT(bench.errors(), Contains("pressure_Pa"));
  CHECK(bench.start("b", {"--set", "body.lid.contact=nodes"}) == 2);
  CHECK_FALSE(std::filesystem::exists(bench.folder / "a/history.csv"));
}
