// Ground of any form: distances, rocks and soil on it, and what is said of a map that cannot be used.
#include <cmath>

#include "tests/catch.hpp"
#include "tests/mpm/rock_refusals.hpp"
#include "tests/mpm/rocks.hpp"
#include "tests/mpm/rocks_alone.hpp"
#include "tests/mpm/scene_runs.hpp"

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

std::string ground(int d, const std::string& centre, const std::string& map, const std::string& more = "") {
  (void)d;
  return "[[body]]\nname = \"ground\"\nkind = \"terrain\"\ncentre_m = " + centre + "\n" + map + more;
}

template <int D>
std::unique_ptr<Model<D>> model_of(const std::string& text) {
  const rvelab::test::Folder folder;
  std::ofstream(folder / "scene.toml") << text;
  return set_up<D>(read_scene(folder / "scene.toml", {}, {}), 1, folder.path());
}

const std::string ball = "[[rock]]\nname = \"ball\"\nmaterial = \"basalt\"\nradius_m = 0.1\ncentre_m = ";

}  // namespace

TEST_CASE("the distance from a map of a plane is that from the half-space, beyond its edges too") {
  const auto model = model_of<3>(
      rocks_alone(3, ground(3, "[1, 2, 3]", map_of(3, 0.25, 7, [](double x, double y) { return 0.5 * x - 0.3 * y; })) +
                         ball + "[1, 2, 9]\n"));
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
      rocks_alone(2, ground(2, "[0, 0]", map_of(2, 0.1, 41, [](double x, double) { return (x - 2) * (x - 2) / 4; })) +
                         ball + "[2, 5]\n"));
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
    std::string scene = rocks_alone(d, ground(d, centre, map_of(d, 0.1, 41, valley)) + ball +
                                           (d == 2 ? "[2.03, 0.1002368]\n" : "[2.03, 0.5, 0.1002368]\n"));
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
  const std::string rock =
      "[[rock]]\nname = \"egg\"\nmaterial = \"basalt\"\nshape = \"superquadric\"\nhalf_axes_m = [0.3, 0.2, 0.1]\n"
      "blockiness = [2, 4]\nrotation_deg = [1, 2, 3, 40]\ncentre_m = [0.6, 0.7, 0.9]\n";
  const auto gap = [&](const std::string& below) {
    const auto model = model_of<3>(rocks_alone(3, below + rock));
    const auto& solver = model->solver;
    return solver.rocks->gap_to(solver.rocks->all[0], walls_at<3>(solver.grid, solver.planes, solver.bodies, 0)[0]);
  };
  const auto on_map =
      gap(ground(3, "[0, 0, 0]", map_of(3, 0.2, 9, [](double x, double y) { return 0.4 * x + 0.2 * y; })));
  const auto on_plane =
      gap("[[body]]\nname = \"p\"\nkind = \"half_space\"\ncentre_m = [0, 0, 0]\nnormal = [-0.4, -0.2, 1]\n");
  CHECK(on_map.gap == Approx(on_plane.gap).margin(1e-12));
  CHECK((on_map.normal - on_plane.normal).norm() < 1e-12);
  CHECK((on_map.place - on_plane.place).norm() < 1e-12);
}

TEST_CASE("a ball much larger than the spacing of the map slides on its slope as on a half-space") {
  const auto place_after = [](const std::string& below) {
    const auto model =
        model_of<2>(rocks_alone(2, below + "[[rock]]\nname = \"ball\"\nmaterial = \"basalt\"\nradius_m = 0.3\n"
                                           "centre_m = [0.5, 1.1]\n"));
    auto& solver = model->solver;
    while (solver.time < 0.3) solver.step(1e-3);
    return solver.rocks->all[0].body.centre;
  };
  const Vec<2> on_map =
      place_after(ground(2, "[0, 0]", map_of(2, 0.05, 41, [](double x, double) { return 1 - 0.5 * x; })));
  const Vec<2> on_plane =
      place_after("[[body]]\nname = \"p\"\nkind = \"half_space\"\ncentre_m = [0, 1]\nnormal = [0.5, 1]\n");
  CHECK(on_plane[0] > 0.6);
  CHECK((on_map - on_plane).norm() < 1e-9);
}

TEST_CASE("a slab that is laid on a ridge rocks there and keeps its energy") {
  const auto model = model_of<2>(rocks_alone(
      2, ground(2, "[0, 0]", map_of(2, 0.1, 41, [](double x, double) { return 1 - (x - 2) * (x - 2) / 4; })) +
             "[[rock]]\nname = \"slab\"\nmaterial = \"basalt\"\nshape = \"superquadric\"\nhalf_axes_m = [0.6, 0.15]\n"
             "blockiness = [10]\ncentre_m = [2.05, 1.16]\n"));
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
  const auto soil = [](const std::string& below, const std::string& lower) {
    return "[scene]\nname = \"soil\"\ndimension = 2\n[grid]\ncell_m = 0.1\n[time]\nduration_s = 1\n[loads]\n"
           "gravity_m_s2 = [0, -10]\n[[material]]\nname = \"soil\"\nkind = \"elastic\"\ndensity_kg_m3 = 1600\n"
           "young_modulus_Pa = 1e6\n[[region]]\nmaterial = \"soil\"\nlower_m = " +
           lower + "\nupper_m = [2, 1]\n" + below;
  };
  SECTION("its volume is that above the map") {
    // 0.4 sin^2 (pi x/2) over 2 m: 0.4 m2 under it.
    const auto model = model_of<2>(
        soil(ground(2, "[0, 0]",
                    map_of(2, 0.05, 41,
                           [](double x, double) { return 0.4 * std::pow(std::sin(3.14159265358979 * x / 2), 2); })),
             "[0, 0]"));
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
      auto model = model_of<2>(soil(below, "[1, 0.8]"));
      auto& solver = model->solver;
      while (solver.time < 0.3) solver.step(1e-3);
      return solver.points;
    };
    const auto slope = map_of(2, 0.5, 9, [](double x, double) { return 1 - 0.25 * x; });
    const auto on_map = moved(ground(2, "[0, 0]", slope, "friction = 0.1\n"));
    const auto on_plane =
        moved("[[body]]\nname = \"p\"\nkind = \"half_space\"\ncentre_m = [0, 1]\nnormal = [0.25, 1]\nfriction = 0.1\n");
    REQUIRE(on_map.size() == on_plane.size());
    CHECK(on_plane[0].velocity[0] > 0.1);
    for (std::size_t k = 0; k < on_map.size(); ++k) CHECK((on_map[k].position - on_plane[k].position).norm() < 1e-9);
  }
}

TEST_CASE("soil does not fall through steep sides of a gorge, and a region under ground is refused") {
  const auto scene = [](double height) {
    return "[scene]\nname = \"gorge\"\ndimension = 2\n[grid]\ncell_m = 0.1\n[time]\nduration_s = 1\n[loads]\n"
           "gravity_m_s2 = [0, -10]\n[[material]]\nname = \"soil\"\nkind = \"elastic\"\ndensity_kg_m3 = 1600\n"
           "young_modulus_Pa = 1e6\n[[region]]\nmaterial = \"soil\"\nlower_m = [1.1, 0.1]\nupper_m = [1.9, 0.8]\n" +
           ground(2, "[0, " + std::to_string(height) + "]", map_of(2, 0.1, 31, [](double x, double) {
                    return std::max(0.0, 3.7 * (std::abs(x - 1.5) - 0.4));  // 75 degrees
                  }));
  };
  const auto model = model_of<2>(scene(0));
  auto& solver = model->solver;
  while (solver.time < 0.5) solver.step(solver.stable_step());
  Vec<2> outward;
  for (const auto& point : solver.points) CHECK(solver.bodies.all[0].distance(point.position, outward) > 0);
  CHECK_THROWS_WITH(model_of<2>(scene(3)), Catch::Matchers::Contains("no point that is clear of terrain and rocks"));
}

TEST_CASE("maps that cannot be used are refused with what to do") {
  const auto refusal = [](const std::string& body) {
    try {
      model_of<3>(rocks_alone(
          3, "[[body]]\nname = \"ground\"\nkind = \"terrain\"\ncentre_m = [0, 0, 0]\n" + body + ball + "[0, 0, 9]\n"));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  using Catch::Matchers::Contains;
  CHECK(refusal("spacing_m = 1\nheights_m = [[0, 0], [0, 1]]\n") == "none");
  CHECK_THAT(refusal("heights_m = [[0, 0], [0, 1]]\n"), Contains("spacing_m"));
  CHECK_THAT(refusal("spacing_m = 1\n"), Contains("heights_m (rows along x) or file_csv"));
  CHECK_THAT(refusal("spacing_m = 1\nheights_m = [[0, 0], [0]]\n"), Contains("heights_m must be rows of 2 numbers"));
  CHECK_THAT(refusal("spacing_m = 1\nheights_m = [0, 1, 0]\n"), Contains("heights_m = [[0.5, 0.3, 0.2]]"));
  CHECK_THAT(refusal("spacing_m = 1\nheights_m = [[0, 1, 0]]\n"), Contains("two heights or more along each"));
  CHECK_THAT(refusal("spacing_m = 1\nheights_m = [[0, 9], [0, 9]]\n"), Contains("degrees; allowed: 80"));
  CHECK_THAT(refusal("spacing_m = 1\nfile_csv = \"none.csv\"\n"), Contains("none.csv: cannot be read"));
  CHECK_THAT(refusal("spacing_m = 1\nheights_m = [[0, 0], [0, 1]]\nfile_csv = \"a.csv\"\n"),
             Contains("remove one of them"));
}

TEST_CASE("a map in a file is that of the scene, and the run's folder keeps it") {
  const auto text = [](const std::string& map) {
    return rocks_alone(2, "[[body]]\nname = \"ground\"\nkind = \"terrain\"\ncentre_m = [0, 0]\nfriction = 0.5\n" + map +
                              ball + "[1.2, 0.5]\n");
  };
  const SceneRuns inside(text("spacing_m = 0.5\nheights_m = [[0.4, 0.1, 0.0, 0.1, 0.5]]\n"));
  std::ofstream(inside.folder / "map.csv") << "0.4, 0.1, 0, 0.1, 0.5\n";
  std::ofstream(inside.folder / "other.toml") << text("spacing_m = 0.5\nfile_csv = \"map.csv\"\n");
  REQUIRE(inside.start("a") == 0);
  REQUIRE(inside.run({inside.folder / "other.toml", "-o", inside.folder / "b"}) == 0);
  inside.expect_same("a", "b", 3);
  std::filesystem::remove(inside.folder / "map.csv");
  REQUIRE(inside.run({"--resume", inside.folder / "b", "--set", "time.duration_s=0.6"}) == 0);
}
