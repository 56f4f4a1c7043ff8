// Tables of grains that become points, and tables of rocks that a run leaves.
#include "tests/mpm/rock_scenes.hpp"
#include "tests/mpm/rocks.hpp"
#include "tests/mpm/scene_runs.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

/// Soil of a table of grains, porosity 0.4, and one rock at the origin whose radius is 0.5 m.
std::string grains_scene(int d) {
  const bool plane = d == 2;
  return head("grains", "0.25", "1", d, plane ? "thickness_m = 0.3\n" : "") +
         soil_of("soil", "elastic", "1500", "1e6") + basalt() +
         "[[region]]\nmaterial = \"soil\"\ntable = \"fine.csv\"\nporosity = 0.4\nvelocity_m_s = " +
         (plane ? "[0, -1]\n" : "[0, 0, -1]\n") + rock("big", plane ? "[0, 0]" : "[0, 0, 0]", "radius_m = 0.5\n") +
         "[rock_soil]\ncontact = \"ghost\"\n";
}

Change grains(const std::string& rows, const std::string& from = "", const std::string& to = "") {
  return {{}, from, to, {{"fine.csv", rows}}};
}

std::vector<std::vector<double>> rows_in(const std::string& path) { return History(path).rows; }

}  // namespace

TEST_CASE("a table of grains becomes points at their places, with their solids and pores") {
  const auto plane = model_of<2>(grains_scene(2), grains("x,y,r\n1,9,0.1\n2,9,0.15\n"));
  REQUIRE(plane->solver.points.size() == 2);
  for (int k = 0; k < 2; ++k) {
    const auto& point = plane->solver.points[std::size_t(k)];
    const double r = 0.1 + 0.05 * k, volume = pi * r * r * 0.3 / 0.6;
    CHECK(point.position == Vec<2>(1.0 + k, 9.0));
    CHECK(point.velocity == Vec<2>(0.0, -1.0));
    CHECK(point.volume == Approx(volume));
    CHECK(point.mass == Approx(1500 * volume));
    CHECK(4 * point.half.prod() * 0.3 == Approx(volume));
  }
  const auto space = model_of<3>(grains_scene(3), grains("1,2,9,0.1\n"));
  REQUIRE(space->solver.points.size() == 1);
  CHECK(space->solver.points[0].position == Vec<3>(1.0, 2.0, 9.0));
  CHECK(space->solver.points[0].volume == Approx(4 * pi / 3 * 1e-3 / 0.6));
}

TEST_CASE("to rocks a grain of a table is the ball that it was") {
  // Touching, overlapping by a hundredth and by a third of its radius, by two thirds.
  const auto plane = model_of<2>(grains_scene(2), grains("0.6,0,0.1\n0,0.599,0.1\n-0.566,0,0.1\n0,-0.533,0.1\n"));
  CHECK(plane->solver.points.size() == 3);
  CHECK(plane->solver.rocks->left_out == 1);
  REQUIRE(plane->solver.rocks->balls.size() == 3);
  CHECK(plane->solver.rocks->balls[0] == Approx(0.1));
  CHECK(plane->solver.rocks->balls[1] == 0.1);
  CHECK(plane->solver.rocks->balls[2] == Approx(0.066));
  const auto space = model_of<3>(grains_scene(3), grains("0,0,0.6,0.1\n"));
  CHECK(space->solver.rocks->balls == std::vector<double>{0.1});
}

TEST_CASE("what a table of grains may not be is refused") {
  const std::string good = "1,9,0.1\n", table = "[[region]]\nmaterial = \"soil\"\ntable";
  const auto box = region("soil", "[0, 8.5]", "[2, 9.5]") + table;
  expect_said(grains_scene(2),
              {{grains(good), {"accepted"}},
               {grains(good, "porosity = 0.4", ""), {"region.porosity is missing"}},
               {grains(good, "porosity = 0.4", "porosity = 1.4"), {"region.porosity = 1.4"}},
               {grains(good, "porosity", "lower_m = [0, 0]\nporosity"), {"lower_m", "filled"}},
               {grains(good, "porosity", "points_per_cell = 9\nporosity"), {"points_per_cell", "filled"}},
               {grains("1,9\n"), {"rows of 2 numbers; give x, y, radius"}},
               {grains("1,9,-0.1\n"), {"radius -0.1", "positive"}},
               {grains("1,9,O.1\n"), {"fine.csv:1: holds O.1"}},
               {grains(good, "fine.csv", "none.csv"), {"none.csv: no such file", "region.table"}},
               {grains(good, "table =", "tabel ="), {"region.porosity", "table of grains", "give table"}},
               {grains(good, "contact = \"ghost\"", "contact = \"ghost\"\nporosity = 0.4"), {"rock_soil.porosity"}},
               {grains(good, "table = \"fine.csv\"", "table = 5"), {"region.table"}},
               {grains(good, table, box), {"would fill that place twice"}},
               {grains("1,7,0.1\n", table, box), {"accepted"}}});
  expect_said(rocks_in_plane, {{set("region.0.porosity=0.4"), {"region.porosity", "table of grains", "give table"}}});
}

TEST_CASE("a run leaves tables of its rocks, from which another one goes on") {
  const std::string share = "volume_share = 0.2\ndiameters_m = [[0.3, 1]]\n";
  const auto drawn = rocks("discs", "lower_m = [0, 0]\nupper_m = [2, 1]\n" + share) +
                     rocks("slabs", "lower_m = [0, 1]\nupper_m = [2, 2]\naspect = [2, 1]\nblockiness = [4]\n" + share);
  const auto from_tables = rocks("discs", "table = \"first/rocks_discs.csv\"\n") +
                           rocks("slabs", "table = \"first/rocks_slabs.csv\"\nblockiness = [4]\n");
  const SceneRuns runs(rocks_alone(2, drawn));
  REQUIRE(runs.start("first", {"--set", "time.duration_s=0.05"}) == 0);
  const SceneRuns next(rocks_alone(2, from_tables));
  std::filesystem::copy(runs.folder / "first", next.folder / "first");
  REQUIRE(next.start("second", {"--set", "time.duration_s=1e-9"}) == 0);
  for (const std::string name : {"discs", "slabs"}) {
    CAPTURE(name);
    const auto first = rows_in(runs.folder / ("first/rocks_" + name + ".csv"));
    const auto second = rows_in(next.folder / ("second/rocks_" + name + ".csv"));
    REQUIRE(first.size() > 2);
    REQUIRE(second.size() == first.size());
    for (std::size_t k = 0; k < first.size(); ++k) {
      REQUIRE(first[k].size() == (name == "discs" ? 3 : 5));
      for (std::size_t i = 0; i < first[k].size(); ++i) CHECK(second[k][i] == Approx(first[k][i]).margin(1e-12));
    }
    CHECK(first[0][0] > 0);
  }
  // They fell 0.0125 m, but for those that met another.
  const auto begun = rows_in(runs.folder / "first/rocks_slabs.csv");
  REQUIRE(runs.start("none", {"--set", "time.duration_s=1e-9"}) == 0);
  const auto drawn_at = rows_in(runs.folder / "none/rocks_slabs.csv");
  CHECK(begun[0][1] < drawn_at[0][1]);
}
