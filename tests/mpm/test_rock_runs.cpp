// Rocks in runs of the program: the same bytes by any number of threads, and after a stop.
#include <algorithm>
#include <sstream>

#include "tests/mpm/blocks.hpp"
#include "tests/mpm/rocks_alone.hpp"
#include "tests/mpm/scene_runs.hpp"
#include "tools/mpm/rocks/rocks.hpp"
#include "tools/mpm/setup/setup.hpp"

using Catch::Matchers::Contains;
using mpm::test::pi;
using mpm::test::rocks_alone;
using mpm::test::SceneRuns;
using rvelab::test::bytes_of;
using rvelab::test::Child;
using rvelab::test::Folder;

namespace {

/// A sphere, a block and two drawn superquadrics that fall on 512 points of soil between walls.
constexpr const char* falling_scene = R"(
[scene]
name = "falling"
dimension = 3
[grid]
cell_m = 0.1
[time]
duration_s = 0.06
[loads]
gravity_m_s2 = [0, 0, -10]
[[material]]
name = "soil"
kind = "mohr_coulomb"
density_kg_m3 = 1600
young_modulus_Pa = 1e6
[[region]]
material = "soil"
lower_m = [0, 0, 0]
upper_m = [0.4, 0.4, 0.4]
[[rock_material]]
name = "basalt"
density_kg_m3 = 2700
young_modulus_Pa = 1e6
[[rock]]
name = "ball"
material = "basalt"
radius_m = 0.09
centre_m = [0.11, 0.12, 0.5]
velocity_m_s = [0.5, 0, -1]
spin_rad_s = [3, 0, 1]
[[rock]]
name = "block"
material = "basalt"
shape = "superquadric"
half_axes_m = [0.1, 0.08, 0.07]
blockiness = [6, 6]
rotation_deg = [1, 1, 0, 20]
centre_m = [0.28, 0.28, 0.52]
velocity_m_s = [0, 0, 2]
[[rocks]]
name = "stones"
material = "basalt"
lower_m = [0.1, 0.1, 0.62]
upper_m = [0.38, 0.38, 0.84]
volume_share = 0.27
diameters_m = [[0.165, 1]]
aspect = [1.1, 1, 0.95]
blockiness = [4, 3]
[rock_soil]
friction = 0.4
[[body]]
name = "table"
kind = "half_space"
centre_m = [0, 0, 0]
normal = [0, 0, 1]
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
[output]
frame_every_s = 0.03
history_every_s = 0.002
checkpoint_every_s = 0.03
)";

/// Soil with a third of rocks by volume under a plate that presses it.
constexpr const char* pressed_scene = R"(
[scene]
name = "pressed"
dimension = 3
[grid]
cell_m = 0.05
[time]
duration_s = 0.01
[initial]
stress = "isotropic"
pressure_Pa = 5e3
[[material]]
name = "soil"
kind = "mohr_coulomb"
density_kg_m3 = 1600
young_modulus_Pa = 1e6
[[region]]
material = "soil"
lower_m = [0, 0, 0]
upper_m = [0.5, 0.5, 0.5]
[[rock_material]]
name = "basalt"
density_kg_m3 = 2700
young_modulus_Pa = 1e8
[[rocks]]
name = "stones"
material = "basalt"
lower_m = [0, 0, 0]
upper_m = [0.5, 0.5, 0.5]
volume_share = 0.3
diameters_m = [[0.14, 1]]
gap_m = 2e-3
[[boundary]]
name = "left"
kind = "roller"
axis = "x"
at_m = 0
[[boundary]]
name = "right"
kind = "roller"
axis = "x"
at_m = 0.5
soil = "below"
[[boundary]]
name = "front"
kind = "roller"
axis = "y"
at_m = 0
[[boundary]]
name = "back"
kind = "roller"
axis = "y"
at_m = 0.5
soil = "below"
[[boundary]]
name = "bottom"
kind = "roller"
axis = "z"
at_m = 0
[[body]]
name = "lid"
kind = "half_space"
centre_m = [0, 0, 0.5]
normal = [0, 0, -1]
pressure_Pa = 1e4
pressure_until_s = 0.005
motion = [[0, 0, 0, 0], [0.005, 0, 0, -0.5]]
[output]
frame_every_s = 0.01
history_every_s = 0.001
)";

/// The values of a column of history.csv.
std::vector<double> values_of(const std::string& history, const std::string& column) {
  std::istringstream rows(history);
  std::string row, cell;
  std::getline(rows, row);
  std::istringstream names(row);
  std::size_t place = 0;
  while (std::getline(names, cell, ',') && cell != column) ++place;
  std::vector<double> values;
  while (std::getline(rows, row)) {
    std::istringstream cells(row);
    for (std::size_t k = 0; k <= place; ++k) std::getline(cells, cell, ',');
    values.push_back(std::stod(cell));
  }
  return values;
}

/// A value of the last row of history.csv.
double last_value(const std::string& history, const std::string& column) {
  std::istringstream header(history.substr(0, history.find('\n')));
  std::istringstream row(history.substr(history.rfind('\n', history.size() - 2) + 1));
  std::string name, value;
  while (std::getline(header, name, ',') && std::getline(row, value, ',')) {
    if (name == column) return std::stod(value);
  }
  throw std::runtime_error("no column " + column);
}

}  // namespace

TEST_CASE("rocks that fall on soil leave the same bytes by any number of threads, and stopped and resumed") {
  for (const std::string contact : {"surface", "ghost"}) {
    CAPTURE(contact);
    const SceneRuns bench(falling_scene);
    const std::vector<std::string> set{"--set", "rock_soil.contact=" + contact};
    const auto start = [&](const std::string& name, std::vector<std::string> more) {
      more.insert(more.end(), set.begin(), set.end());
      return bench.start(name, more);
    };
    REQUIRE(start("one", {"-j", "1"}) == 0);
    REQUIRE(start("three", {"-j", "3"}) == 0);
    bench.expect_same("one", "three", 10);
    REQUIRE(start("stopped", {"-j", "1", "--stop-at", "0.0371"}) == 0);
    REQUIRE(bench.run({"--resume", bench.folder / "stopped", "-j", "2"}) == 0);
    bench.expect_same("one", "stopped", 10);
    const auto history = bytes_of(bench.folder / "one/history.csv");
    const std::vector<double> contacts = values_of(history, "rocks.soil_contacts");
    CHECK(std::count_if(contacts.begin(), contacts.end(), [](double each) { return each > 0; }) > 1);  // balls rebound
    CHECK(last_value(history, "ball.z_m") < 0.5);
    CHECK(last_value(history, "rocks.soil_work_J") < 0);
    CHECK(last_value(history, "rocks.contact_loss_J") > 0);
    CHECK(std::abs(last_value(history, "rocks.residual_J")) < 5e-3 * last_value(history, "rocks.contact_loss_J"));
  }
}

TEST_CASE("threads that share the sweeps over the surfaces of many rocks leave the same bytes") {
  const SceneRuns bench(pressed_scene);
  for (const std::string threads : {"1", "2", "3"}) REQUIRE(bench.start(threads, {"-j", threads}) == 0);
  bench.expect_same("1", "2", 5);
  bench.expect_same("1", "3", 5);
  const auto history = bytes_of(bench.folder / "1/history.csv");
  CHECK(last_value(history, "rocks.soil_contacts") > 500);
  CHECK(last_value(history, "rocks.soil_work_J") != 0);
}

TEST_CASE("sweeps over the surfaces of many rocks have the same bits, whether threads share them or not") {
  using rvelab::Workers;
  const Folder folder;
  std::ofstream(folder / "scene.toml") << pressed_scene;
  const auto scene = mpm::read_scene(folder / "scene.toml", {}, {});
  const auto end_of = [&](int threads, Workers::Sharing sharing) {
    auto model = mpm::set_up<3>(scene, threads, folder.path());
    model->solver.workers.sharing = sharing;
    for (int k = 0; k < 25; ++k) model->solver.step(model->solver.stable_step());
    return model;
  };
  const auto one = end_of(1, Workers::Sharing::never);
  CHECK(one->solver.rocks->surface.size() > 500);
  for (const int threads : {2, 3, 5}) {
    for (const auto sharing : {Workers::Sharing::always, Workers::Sharing::never, Workers::Sharing::measured}) {
      if (sharing != Workers::Sharing::always && threads == 5) continue;
      CAPTURE(threads, int(sharing));
      const auto other = end_of(threads, sharing);
      REQUIRE(other->solver.time == one->solver.time);
      for (std::size_t k = 0; k < one->solver.points.size(); ++k) {
        REQUIRE(other->solver.points[k].position == one->solver.points[k].position);
        REQUIRE(other->solver.points[k].stress == one->solver.points[k].stress);
      }
      for (std::size_t k = 0; k < one->solver.rocks->all.size(); ++k) {
        REQUIRE(other->solver.rocks->all[k].body.centre == one->solver.rocks->all[k].body.centre);
        REQUIRE(other->solver.rocks->all[k].soil_impulse == one->solver.rocks->all[k].soil_impulse);
      }
      CHECK(other->solver.rocks->work_on_soil == one->solver.rocks->work_on_soil);
    }
  }
}

TEST_CASE("a flipped bit in the checkpoint of rocks is refused") {
  const SceneRuns bench(falling_scene);
  REQUIRE(bench.start("a", {"-j", "1", "--stop-at", "0.003"}) == 0);
  const auto path = bench.folder / "a/checkpoint.h5";
  const auto whole = bytes_of(path);
  for (std::size_t k = 0; k < 12; ++k) {
    auto damaged = whole;
    damaged[(2 * k + 1) * whole.size() / 24] ^= char(1 << k % 8);
    std::ofstream(path, std::ios::binary) << damaged;
    CAPTURE(k);
    CHECK(bench.run({"--resume", bench.folder / "a", "-j", "1"}) == 2);
    CHECK_THAT(bench.errors(), Contains("checkpoint.h5: is damaged") && Contains("start the run anew"));
  }
  std::ofstream(path, std::ios::binary) << whole;
  CHECK(bench.run({"--resume", bench.folder / "a", "-j", "1", "--set", "rocks.stones.volume_share=0.1"}) == 2);
  CHECK_THAT(bench.errors(), Contains("its checkpoint holds other rocks than this scene"));
}

TEST_CASE("rocks alone, without any soil, fall freely, come to rest on a floor and are resumed to the same bytes") {
  for (const int d : {2, 3}) {
    CAPTURE(d);
    const std::string axis = d == 2 ? "y" : "z", floor = d == 2 ? "[0, 0]" : "[0, 0, 0]";
    const SceneRuns bench(
        rocks_alone(d, "[[rock]]\nname = \"ball\"\nmaterial = \"basalt\"\nradius_m = 0.2\ncentre_m = " +
                           std::string(d == 2 ? "[0, 1.2]" : "[0, 0, 1.2]") +
                           "\n[[rock]]\nname = \"still\"\nmaterial = \"basalt\"\nradius_m = 0.1\ncentre_m = " +
                           std::string(d == 2 ? "[1, 0.1]" : "[1, 0, 0.1]") +
                           "\n[[body]]\nname = \"floor\"\nkind = \"half_space\"\ncentre_m = " + floor +
                           "\nnormal = " + (d == 2 ? "[0, 1]" : "[0, 0, 1]") + "\n"));
    REQUIRE(bench.start("fall", {"--stop-at", "0.4"}) == 0);
    const auto fall = bytes_of(bench.folder / "fall/history.csv");
    const double t = std::stod(fall.substr(fall.rfind('\n', fall.size() - 2) + 1));
    CHECK(last_value(fall, "ball." + axis + "_m") == Approx(1.2 - 5 * t * t).epsilon(1e-9));
    CHECK(last_value(fall, "ball.velocity_" + axis + "_m_s") == Approx(-10 * t).epsilon(1e-9));
    REQUIRE(bench.start("whole") == 0);
    REQUIRE(bench.run({"--resume", bench.folder / "fall"}) == 0);
    bench.expect_same("whole", "fall", 10);
    const auto whole = bytes_of(bench.folder / "whole/history.csv");
    CHECK(last_value(whole, "ball.velocity_" + axis + "_m_s") > 0);  // it has bounced
    const double mass = 2700 * (d == 2 ? pi * 0.01 : 4.0 / 3 * pi * 0.001);
    // It sinks in until the spring carries it: E* = E/(2 (1 - nu^2)), m g = pi/4 E* delta or 4/3 E* sqrt(r) delta^1.5.
    const double e_star = 1e7 / (2 * (1 - 0.0625));
    const double sunk =
        d == 2 ? 10 * mass / (pi / 4 * e_star) : std::pow(10 * mass / (4.0 / 3 * e_star * std::sqrt(0.1)), 2.0 / 3);
    CHECK(0.1 - last_value(whole, "still." + axis + "_m") == Approx(sunk).epsilon(1e-3));
    CHECK(last_value(whole, "floor.force_" + axis + "_N") == Approx(-10 * mass).epsilon(1e-3));
  }
}
