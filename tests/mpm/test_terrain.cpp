// Ground of any form: distances, rocks and soil on it, and what is said of a map that cannot be used.
#include <cmath>

#include "tests/mpm/rocks.hpp"
#include "tests/mpm/scene_runs.hpp"
#include "tests/mpm/scenes.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

/// heights_m and spacing_m of h at x, y = 0, spacing, ... from the centre.
std::string map_of(int d, double spacing, int count, const std::function<double(double, double)>& h) {
  std::ostringstream text;
  text.precision(17);
  text << "spacing_m = " << spacing << "\nheights_m = [";
  for (int j = 0; j < (d == 2 ? 1 : count); ++j) {
    text << "[";
    for (int i = 0; i < count; ++i) text << h(i * spacing, j * spacing) << ", ";
    text << "],\n";
  }
  text << "]\n";
  return text.str();
}

std::string ground(const std::string& centre, const std::string& map, const std::string& more = "") {
  return "[[body]]\nname = \"ground\"\nkind = \"terrain\"\ncentre_m = " + centre + "\n" + map + more;
}

std::string ball_at(const std::string& centre, const std::string& radius = "0.1") {
  return rock("ball", centre, "radius_m = " + radius + "\n");
}

/// Elastic soil in a box on what lies below it.
std::string soil_on(const std::string& below, const std::string& lower, const std::string& upper) {
  return head("soil", "0.1", "1") + "[loads]\ngravity_m_s2 = [0, -10]\n" + soil_of("soil", "elastic", "1600", "1e6") +
         region("soil", lower, upper) + below;
}

}  // namespace

TEST_CASE("the distance from a map of a plane is that from the half-space, beyond its edges too") {
  const auto model = model_of<3>(
      rocks_alone(3, ground("[1, 2, 3]", map_of(3, 0.25, 7, [](double x, double y) { return 0.5 * x - 0.3 * y; })) +
                         ball_at("[1, 2, 9]")));
  const auto& body = model->solver.bodies.all[0];
  const Vec<3> normal = Vec<3>(-0.5, 0.3, 1).normalized();
  for (const double x : {-2.0, 0.1, 0.75, 3.0}) {
    for (const double y : {-1.0, 0.6, 4.0}) {
      for (const double above : {-0.3, 0.0, 0.2}) {
        const Vec<3> r = Vec<3>(x, y, 0.5 * x - 0.3 * y) + above * normal;
        Vec<3> outward;
        CHECK(body.distance(r, outward) == Approx(above).margin(1e-12));
        CHECK((outward - normal).norm() < 1e-12);
      }
    }
  }
}

TEST_CASE("the distance from a parabola is that to its nearest place") {
  // The convolution gives a parabola back, but for the cells at the edges.
  const auto model = model_of<2>(
      rocks_alone(2, ground("[0, 0]", map_of(2, 0.1, 41, [](double x, double) { return (x - 2) * (x - 2) / 4; })) +
                         ball_at("[2, 5]")));
  const auto& body = model->solver.bodies.all[0];
  for (const double s : {0.7, 1.6, 2.0, 2.93}) {
    const double slope = (s - 2) / 2;
    const Vec<2> normal = Vec<2>(-slope, 1).normalized();
    for (const double above : {-0.4, 1e-3, 0.5}) {  // the centre of curvature is 2 m or more away
      Vec<2> outward;
      CHECK(body.distance(Vec<2>(s, (s - 2) * (s - 2) / 4) + above * normal, outward) == Approx(above).margin(1e-10));
      CHECK((outward - normal).norm() < 1e-8);
    }
  }
}

TEST_CASE("a smooth ball in a valley swings as a pendulum of the length between the centres of curvature") {
  const auto valley = [](double x, double) { return (x - 2) * (x - 2) / 4; };  // radius 2 m at its foot
  const double a = 0.03;
  for (const int d : {2, 3}) {
    const std::string centre = d == 2 ? "[0, 0]" : "[0, -1, 0]";
    std::string scene = rocks_alone(d, ground(centre, map_of(d, 0.1, 41, valley)) +
                                           ball_at(d == 2 ? "[2.03, 0.1002368]" : "[2.03, 0.5, 0.1002368]"));
    const auto swing = [&](auto&& solver) {
      const double quarter = 0.5 * 3.14159265358979 * std::sqrt((2 - 0.1) / 10);
      while (solver.time < quarter * (1 - 1e-9)) solver.step(std::min(1e-3, quarter - solver.time));
      CHECK(std::abs(solver.rocks->all[0].body.centre[0] - 2) < 0.01 * a);
      CHECK(solver.rocks->all[0].body.velocity[0] == Approx(-a * std::sqrt(10 / 1.9)).epsilon(0.01));
      CHECK(solver.rocks->all[0].body.spin().norm() < 1e-9);
      const auto energy = solver.rocks->energy(solver.options.gravity);
      CHECK(std::abs(energy.residual) < 0.01 * energy.kinetic);
    };
    if (d == 2)
      swing(model_of<2>(scene)->solver);
    else
      swing(model_of<3>(scene)->solver);
  }
}

TEST_CASE("rocks that are no balls stand as far from a map of a plane as from the half-space") {
  const auto egg = rock("egg", "[0.6, 0.7, 0.9]",
                        "shape = \"superquadric\"\nhalf_axes_m = [0.3, 0.2, 0.1]\nblockiness = [2, 4]\n"
                        "rotation_deg = [1, 2, 3, 40]\n");
  const auto gap = [&](const std::string& below) {
    const auto model = model_of<3>(rocks_alone(3, below + egg));
    const auto& solver = model->solver;
    return solver.rocks->gap_to(solver.rocks->all[0], walls_at<3>(solver.grid, solver.planes, solver.bodies, 0)[0]);
  };
  const auto on_map = gap(ground("[0, 0, 0]", map_of(3, 0.2, 9, [](double x, double y) { return 0.4 * x + 0.2 * y; })));
  const auto on_plane = gap(half_space("p", "[0, 0, 0]", "[-0.4, -0.2, 1]"));
  CHECK(on_map.gap == Approx(on_plane.gap).margin(1e-12));
  CHECK((on_map.normal - on_plane.normal).norm() < 1e-12);
  CHECK((on_map.place - on_plane.place).norm() < 1e-12);
}

TEST_CASE("a ball much larger than the spacing of the map slides on its slope as on a half-space") {
  const auto place_after = [](const std::string& below) {
    const auto model = model_of<2>(rocks_alone(2, below + ball_at("[0.5, 1.1]", "0.3")));
    auto& solver = model->solver;
    while (solver.time < 0.3) solver.step(1e-3);
    return solver.rocks->all[0].body.centre;
  };
  const Vec<2> on_map =
      place_after(ground("[0, 0]", map_of(2, 0.05, 41, [](double x, double) { return 1 - 0.5 * x; })));
  const Vec<2> on_plane = place_after(half_space("p", "[0, 1]", "[0.5, 1]"));
  CHECK(on_plane[0] > 0.6);
  CHECK((on_map - on_plane).norm() < 1e-9);
}

TEST_CASE("a slab that is laid on a ridge rocks there and keeps its energy") {
  const auto model = model_of<2>(rocks_alone(
      2, ground("[0, 0]", map_of(2, 0.1, 41, [](double x, double) { return 1 - (x - 2) * (x - 2) / 4; })) +
             rock("slab", "[2.05, 1.16]", "shape = \"superquadric\"\nhalf_axes_m = [0.6, 0.15]\nblockiness = [10]\n")));
  auto& solver = model->solver;
  double kinetic = 0, worst = 0;
  while (solver.time < 0.5) {
    solver.step(1e-3);
    const auto energy = solver.rocks->energy(solver.options.gravity);
    kinetic = std::max(kinetic, energy.kinetic);
    worst = std::max(worst, std::abs(energy.residual));
  }
  CHECK(kinetic > 1);
  CHECK(worst < 0.01 * kinetic);
  CHECK(solver.rocks->all[0].body.centre[1] > 1);
}

TEST_CASE("soil is filled in above ground, and moves on a slope of a map as on a half-space") {
  SECTION("its volume is that above the map") {
    // 0.4 sin^2 (pi x/2) over 2 m: 0.4 m2 under it.
    const auto model = model_of<2>(
        soil_on(ground("[0, 0]",
                       map_of(2, 0.05, 41,
                              [](double x, double) { return 0.4 * std::pow(std::sin(3.14159265358979 * x / 2), 2); })),
                "[0, 0]", "[2, 1]"));
    double volume = 0;
    for (const auto& point : model->solver.points) {
      volume += point.volume;
      Vec<2> outward;
      CHECK(model->solver.bodies.all[0].distance(point.position, outward) > 0);
    }
    CHECK(volume == Approx(2 - 0.4).epsilon(0.003));
  }
  SECTION("it moves alike") {
    const auto moved = [&](const std::string& below) {
      auto model = model_of<2>(soil_on(below, "[1, 0.8]", "[2, 1]"));
      auto& solver = model->solver;
      while (solver.time < 0.3) solver.step(1e-3);
      return solver.points;
    };
    const auto slope = map_of(2, 0.5, 9, [](double x, double) { return 1 - 0.25 * x; });
    const auto on_map = moved(ground("[0, 0]", slope, "friction = 0.1\n"));
    const auto on_plane = moved(half_space("p", "[0, 1]", "[0.25, 1]", "friction = 0.1\n"));
    REQUIRE(on_map.size() == on_plane.size());
    CHECK(on_plane[0].velocity[0] > 0.1);
    for (std::size_t k = 0; k < on_map.size(); ++k) CHECK((on_map[k].position - on_plane[k].position).norm() < 1e-9);
  }
}

TEST_CASE("soil does not fall through steep sides of a gorge, and a region under ground is refused") {
  const auto scene = [](double height) {
    const auto walls = map_of(2, 0.1, 31, [](double x, double) {
      return std::max(0.0, 3.7 * (std::abs(x - 1.5) - 0.4));  // 75 degrees
    });
    return soil_on(ground("[0, " + std::to_string(height) + "]", walls), "[1.1, 0.1]", "[1.9, 0.8]");
  };
  const auto model = model_of<2>(scene(0));
  auto& solver = model->solver;
  while (solver.time < 0.5) solver.step(solver.stable_step());
  Vec<2> outward;
  for (const auto& point : solver.points) CHECK(solver.bodies.all[0].distance(point.position, outward) > 0);
  CHECK_THROWS_WITH(model_of<2>(scene(3)), Catch::Matchers::Contains("no point that is clear of terrain and rocks"));
}

TEST_CASE("maps that cannot be used are refused with what to do") {
  const struct {
    const char *map, *words;
  } cases[] = {{"spacing_m = 1\nheights_m = [[0, 0], [0, 1]]\n", "accepted"},
               {"heights_m = [[0, 0], [0, 1]]\n", "spacing_m"},
               {"spacing_m = 1\n", "heights_m (rows along x) or file_csv"},
               {"spacing_m = 1\nheights_m = [[0, 0], [0]]\n", "rows of 2 numbers"},
               {"spacing_m = 1\nheights_m = [0, 1, 0]\n", "heights_m = [[0.5, 0.3, 0.2]]"},
               {"spacing_m = 1\nheights_m = [[0, 1, 0]]\n", "two heights or more along each"},
               {"spacing_m = 1\nheights_m = [[0, 9], [0, 9]]\n", "degrees; allowed: 80"},
               {"spacing_m = 1\nfile_csv = \"none.csv\"\n", "none.csv: no such file"},
               {"spacing_m = 1\nheights_m = [[0, 0], [0, 1]]\nfile_csv = \"a.csv\"\n", "remove one of them"}};
  for (const auto& each : cases) {
    const auto said = outcome(rocks_alone(3, ground("[0, 0, 0]", each.map) + ball_at("[0, 0, 9]")));
    CHECK_THAT(said, Catch::Matchers::Contains(each.words));
  }
}

TEST_CASE("a map in a file is that of the scene, and the run's folder keeps it") {
  const auto text = [](const std::string& map) {
    return rocks_alone(2, ground("[0, 0]", "friction = 0.5\n" + map) + ball_at("[1.2, 0.5]"));
  };
  const SceneRuns inside(text("spacing_m = 0.5\nheights_m = [[0.4, 0.1, 0.0, 0.1, 0.5]]\n"));
  std::ofstream(inside.folder / "map.csv") << "0.4, 0.1, 0, 0.1, 0.5\n";
  std::ofstream(inside.folder / "other.toml") << text("spacing_m = 0.5\nfile_csv = \"map.csv\"\n");
  REQUIRE(inside.start("a") == 0);
  REQUIRE(inside.run({inside.folder / "other.toml", "-o", inside.folder / "b"}) == 0);
  inside.expect_same("a", "b", 3);
  std::filesystem::remove(inside.folder / "map.csv");
  REQUIRE(inside.resume("b", {"--set", "time.duration_s=0.6"}) == 0);
}
