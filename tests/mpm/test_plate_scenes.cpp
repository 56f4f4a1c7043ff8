// Plates under pressure in scenes: stress of soil and rocks, areas and masses, the end of the pressure, runs that are
// stopped and resumed.
#include "tests/mpm/plates.hpp"
#include "tests/mpm/scene_runs.hpp"

using namespace mpm;
using namespace mpm::test;
using Catch::Matchers::Contains;

namespace {

/// A cube of soil between three rollers and three plates, with a rock in its middle.
const std::string pressed_cube =
    head("pressed", "0.1", "0.03", 3) + "[initial]\nstress = \"isotropic\"\npressure_Pa = 2e4\n" +
    soil_of("soil", "elastic", "2000", "1e7", "poisson_ratio = 0.25\n") +
    region("soil", "[0, 0, 0]", "[0.6, 0.6, 0.6]") + boundary("left", "roller", "x", "0") +
    boundary("front", "roller", "y", "0") + boundary("bottom", "roller", "z", "0") +
    half_space("right", "[0.6, 0, 0]", "[-1, 0, 0]", "pressure_Pa = 2e4\n") +
    half_space("back", "[0, 0.6, 0]", "[0, -1, 0]", "pressure_Pa = 2e4\n") +
    half_space("top", "[0, 0, 0.6]", "[0, 0, -1]", "pressure_Pa = 2e4\n") + basalt() +
    rock("stone", "[0.3, 0.3, 0.3]", "radius_m = 0.16\n") +
    "[rock_soil]\nrough = true\n"
    "[output]\nhistory_every_s = 0.001\nframe_every_s = 0.006\ncheckpoint_every_s = 0.006\n";

}  // namespace

TEST_CASE("the mean stress of soil and a rock in it is that of the plates around them") {
  constexpr double p = 2e4;
  const auto model = model_of<3>(pressed_cube, set("time.pic_fraction=1"));
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
  const auto plane = model_of<2>(pressed_block);
  const auto& lid = *plane->solver.bodies.all[0].plate;
  CHECK(lid.area == Approx(2 * 0.4).epsilon(1e-14));
  CHECK(lid.mass == Approx(2000 * 0.8 * 0.1).epsilon(1e-12));
  const auto given = model_of<2>(pressed_block, set({"body.lid.area_m2=0.7", "body.lid.plate_mass_kg=5"}));
  CHECK(given->solver.bodies.all[0].plate->area == 0.7);
  CHECK(given->solver.bodies.all[0].plate->mass == 5);
  const auto cube = model_of<3>(pressed_cube);
  for (const auto& body : cube->solver.bodies.all) CHECK(body.plate->area == Approx(0.36).epsilon(1e-14));
  const auto round =
      edited(edited(pressed_block, boundary("left", "roller", "x", "0"), ""),
             boundary("right", "roller", "x", "0.4", below), boundary("sides", "periodic", "x", "0", "to_m = 0.4\n"));
  CHECK(model_of<2>(round)->solver.bodies.all[0].plate->area == Approx(0.8).epsilon(1e-14));
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
    REQUIRE(bench.resume(name, {"-j", "3"}) == 0);
    bench.expect_same("one", name, 10);
  }
  const auto history = bench.history("one");
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
  CHECK(held != 0);
  CHECK(history.last("time_s") > 0.019);
  CHECK(history.last("right.displacement_x_m") < 0);  // pressed in
  CHECK(history.last("top.force_z_N") > 2e4 * 0.36);  // squeezed
}

TEST_CASE("the program refuses a plate that is none with status 2") {
  const SceneRuns bench(pressed_block);
  CHECK(bench.start("a", {"--set", "body.lid.pressure_Pa=-1"}) == 2);
  CHECK_THAT(bench.errors(), Contains("pressure_Pa"));
  CHECK(bench.start("b", {"--set", "body.lid.contact=nodes"}) == 2);
  CHECK_FALSE(std::filesystem::exists(bench.folder / "a/history.csv"));
}
