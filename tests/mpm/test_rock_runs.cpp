// Rocks in runs of the program: the same bytes by any number of threads, and after a stop.
#include "tests/mpm/blocks.hpp"
#include "tests/mpm/scene_runs.hpp"
#include "tests/mpm/scenes.hpp"
#include "tools/mpm/rocks/rocks.hpp"

using namespace mpm::test;
using Catch::Matchers::Contains;
using rvelab::test::bytes_of;

namespace {

/// A sphere, a block and two drawn superquadrics that fall on 512 points of soil between walls.
const std::string falling_scene =
    head("falling", "0.1", "0.06", 3) + "[loads]\ngravity_m_s2 = [0, 0, -10]\n" +
    soil_of("soil", "mohr_coulomb", "1600", "1e6") + region("soil", "[0, 0, 0]", "[0.4, 0.4, 0.4]") + basalt("1e6") +
    rock("ball", "[0.11, 0.12, 0.5]", "radius_m = 0.09\nvelocity_m_s = [0.5, 0, -1]\nspin_rad_s = [3, 0, 1]\n") +
    rock("block", "[0.28, 0.28, 0.52]",
         "shape = \"superquadric\"\nhalf_axes_m = [0.1, 0.08, 0.07]\nblockiness = [6, 6]\n"
         "rotation_deg = [1, 1, 0, 20]\nvelocity_m_s = [0, 0, 2]\n") +
    rocks("stones",
          "lower_m = [0.1, 0.1, 0.62]\nupper_m = [0.38, 0.38, 0.84]\nvolume_share = 0.27\n"
          "diameters_m = [[0.165, 1]]\naspect = [1.1, 1, 0.95]\nblockiness = [4, 3]\n") +
    "[rock_soil]\nfriction = 0.4\n" + half_space("table", "[0, 0, 0]", "[0, 0, 1]") +
    boundary("left", "roller", "x", "0") + boundary("front", "roller", "y", "0") +
    "[output]\nframe_every_s = 0.03\nhistory_every_s = 0.002\ncheckpoint_every_s = 0.03\n";

/// Soil with a third of rocks by volume under a plate that presses it.
const std::string pressed_scene =
    head("pressed", "0.05", "0.01", 3) + "[initial]\nstress = \"isotropic\"\npressure_Pa = 5e3\n" +
    soil_of("soil", "mohr_coulomb", "1600", "1e6") + region("soil", "[0, 0, 0]", "[0.5, 0.5, 0.5]") + basalt() +
    rocks("stones",
          "lower_m = [0, 0, 0]\nupper_m = [0.5, 0.5, 0.5]\nvolume_share = 0.3\ndiameters_m = [[0.14, 1]]\n"
          "gap_m = 2e-3\n") +
    boundary("left", "roller", "x", "0") + boundary("right", "roller", "x", "0.5", below) +
    boundary("front", "roller", "y", "0") + boundary("back", "roller", "y", "0.5", below) +
    boundary("bottom", "roller", "z", "0") +
    half_space("lid", "[0, 0, 0.5]", "[0, 0, -1]",
               "pressure_Pa = 1e4\npressure_until_s = 0.005\nmotion = [[0, 0, 0, 0], [0.005, 0, 0, -0.5]]\n") +
    "[output]\nframe_every_s = 0.01\nhistory_every_s = 0.001\n";

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
    REQUIRE(bench.resume("stopped", {"-j", "2"}) == 0);
    bench.expect_same("one", "stopped", 10);
    const auto history = bench.history("one");
    long touching = 0;
    for (std::size_t k = 0; k < history.rows.size(); ++k) touching += history.at(k, "rocks.soil_contacts") > 0;
    CHECK(touching > 1);  // balls rebound
    CHECK(history.last("ball.z_m") < 0.5);
    CHECK(history.last("rocks.soil_work_J") < 0);
    CHECK(history.last("rocks.contact_loss_J") > 0);
    CHECK(std::abs(history.last("rocks.residual_J")) < 5e-3 * history.last("rocks.contact_loss_J"));
  }
}

TEST_CASE("threads that share the sweeps over the surfaces of many rocks leave the same bytes") {
  const SceneRuns bench(pressed_scene);
  for (const std::string threads : {"1", "2", "3"}) REQUIRE(bench.start(threads, {"-j", threads}) == 0);
  bench.expect_same("1", "2", 5);
  bench.expect_same("1", "3", 5);
  const auto history = bench.history("1");
  CHECK(history.last("rocks.soil_contacts") > 500);
  CHECK(history.last("rocks.soil_work_J") != 0);
}

TEST_CASE("sweeps over the surfaces of many rocks have the same bits, whether threads share them or not") {
  using rvelab::Workers;
  const rvelab::test::Folder folder;
  const auto scene = scene_of(pressed_scene, {}, folder);
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
    CHECK(bench.resume("a", {"-j", "1"}) == 2);
    CHECK_THAT(bench.errors(), Contains("checkpoint.h5: ") && Contains("again"));
  }
  std::ofstream(path, std::ios::binary) << whole;
  CHECK(bench.resume("a", {"-j", "1", "--set", "rocks.stones.volume_share=0.1"}) == 2);
  CHECK_THAT(bench.errors(), Contains("its checkpoint holds") && Contains("rocks"));
}

TEST_CASE("rocks alone, without any soil, fall freely, come to rest on a floor and are resumed to the same bytes") {
  for (const int d : {2, 3}) {
    CAPTURE(d);
    const std::string axis = d == 2 ? "y" : "z";
    const bool plane = d == 2;
    const SceneRuns bench(
        rocks_alone(d, rock("ball", plane ? "[0, 1.2]" : "[0, 0, 1.2]", "radius_m = 0.2\n") +
                           rock("still", plane ? "[1, 0.1]" : "[1, 0, 0.1]", "radius_m = 0.1\n") +
                           half_space("floor", plane ? "[0, 0]" : "[0, 0, 0]", plane ? "[0, 1]" : "[0, 0, 1]")));
    REQUIRE(bench.start("fall", {"--stop-at", "0.4"}) == 0);
    const auto fall = bench.history("fall");
    const double t = fall.last("time_s");
    CHECK(fall.last("ball." + axis + "_m") == Approx(1.2 - 5 * t * t).epsilon(1e-9));
    CHECK(fall.last("ball.velocity_" + axis + "_m_s") == Approx(-10 * t).epsilon(1e-9));
    REQUIRE(bench.start("whole") == 0);
    REQUIRE(bench.resume("fall") == 0);
    bench.expect_same("whole", "fall", 10);
    const auto whole = bench.history("whole");
    CHECK(whole.last("ball.velocity_" + axis + "_m_s") > 0);  // it has bounced
    const double mass = 2700 * (d == 2 ? pi * 0.01 : 4.0 / 3 * pi * 0.001);
    // It sinks in until the spring carries it: E* = E/(2 (1 - nu^2)), m g = pi/4 E* delta or 4/3 E* sqrt(r) delta^1.5.
    const double e_star = 1e7 / (2 * (1 - 0.0625));
    const double sunk =
        d == 2 ? 10 * mass / (pi / 4 * e_star) : std::pow(10 * mass / (4.0 / 3 * e_star * std::sqrt(0.1)), 2.0 / 3);
    CHECK(0.1 - whole.last("still." + axis + "_m") == Approx(sunk).epsilon(1e-3));
    CHECK(whole.last("floor.force_" + axis + "_N") == Approx(-10 * mass).epsilon(1e-3));
  }
}
