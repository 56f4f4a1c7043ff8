// Tables of grains that become points, and tables of rocks that a run leaves.
#include <sstream>

#include "tests/mpm/rock_refusals.hpp"
#include "tests/mpm/rocks.hpp"
#include "tests/mpm/rocks_alone.hpp"
#include "tests/mpm/scene_runs.hpp"

using Catch::Matchers::Contains;
using namespace mpm;
using namespace mpm::test;

namespace {

/// Soil of a table of grains, porosity 0.4, and one rock at the origin whose radius is 0.5 m.
template <int D>
std::string grains_scene() {
  return std::string(of_any_rocks) + "[scene]\nname = \"grains\"\ndimension = " + std::to_string(D) +
         (D == 2 ? "\nthickness_m = 0.3" : "") +
         "\n[grid]\ncell_m = 0.25\n[[region]]\nmaterial = \"soil\"\ntable = \"fine.csv\"\nporosity = 0.4\n"
         "velocity_m_s = " +
         (D == 2 ? "[0, -1]" : "[0, 0, -1]") +
         "\n[[rock]]\nname = \"big\"\nmaterial = \"basalt\"\nradius_m = 0.5\ncentre_m = " +
         (D == 2 ? "[0, 0]" : "[0, 0, 0]") + "\n[rock_soil]\ncontact = \"ghost\"\n";
}

template <int D>
std::unique_ptr<Model<D>> model_of(const std::string& text, const std::string& rows) {
  const rvelab::test::Folder folder;
  std::ofstream(folder / "scene.toml") << text;
  std::ofstream(folder / "fine.csv") << rows;
  return set_up<D>(read_scene(folder / "scene.toml", {}, {}), 1, folder.path());
}

std::string grains_told(const std::string& rows, const std::string& from = "", const std::string& to = "") {
  return told_of(grains_scene<2>(), {{}, from, to, {{"fine.csv", rows}}});
}

std::vector<std::vector<double>> rows_in(const std::string& path) {
  std::istringstream text(rvelab::test::bytes_of(path));
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    std::istringstream words(line);
    rows.emplace_back();
    for (std::string word; std::getline(words, word, ',');) rows.back().push_back(std::stod(word));
  }
  return rows;
}

}  // namespace

TEST_CASE("a table of grains becomes points at their places, with their solids and pores") {
  const auto plane = model_of<2>(grains_scene<2>(), "x,y,r\n1,9,0.1\n2,9,0.15\n");
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
  const auto space = model_of<3>(grains_scene<3>(), "1,2,9,0.1\n");
  REQUIRE(space->solver.points.size() == 1);
  CHECK(space->solver.points[0].position == Vec<3>(1.0, 2.0, 9.0));
  CHECK(space->solver.points[0].volume == Approx(4 * pi / 3 * 1e-3 / 0.6));
}

TEST_CASE("to rocks a grain of a table is the ball that it was") {
  // Touching, overlapping by a hundredth and by a third of its radius, by two thirds.
  const auto plane = model_of<2>(grains_scene<2>(), "0.6,0,0.1\n0,0.599,0.1\n-0.566,0,0.1\n0,-0.533,0.1\n");
  CHECK(plane->solver.points.size() == 3);
  CHECK(plane->solver.rocks->left_out == 1);
  REQUIRE(plane->solver.rocks->balls.size() == 3);
  CHECK(plane->solver.rocks->balls[0] == Approx(0.1));
  CHECK(plane->solver.rocks->balls[1] == 0.1);
  CHECK(plane->solver.rocks->balls[2] == Approx(0.066));
  const auto space = model_of<3>(grains_scene<3>(), "0,0,0.6,0.1\n");
  CHECK(space->solver.rocks->balls == std::vector<double>{0.1});
}

TEST_CASE("what a table of grains may not be is refused") {
  CHECK(grains_told("1,9,0.1\n") == "accepted");
  CHECK_THAT(grains_told("1,9,0.1\n", "porosity = 0.4", ""), Contains("region.porosity is missing"));
  CHECK_THAT(grains_told("1,9,0.1\n", "porosity = 0.4", "porosity = 1.4"), Contains("region.porosity is 1.4"));
  CHECK_THAT(grains_told("1,9,0.1\n", "porosity", "lower_m = [0, 0]\nporosity"),
             Contains("lower_m is of a region that is filled"));
  CHECK_THAT(grains_told("1,9,0.1\n", "porosity", "points_per_cell = 9\nporosity"),
             Contains("points_per_cell is of a region that is filled"));
  CHECK_THAT(grains_told("1,9\n"), Contains("has rows of 2 numbers; give x, y, radius"));
  CHECK_THAT(grains_told("1,9,-0.1\n"), Contains("has a grain of radius -0.1; radii must be positive"));
  CHECK_THAT(grains_told("1,9,O.1\n"), Contains("fine.csv:1: holds O.1"));
  CHECK_THAT(grains_told("1,9,0.1\n", "fine.csv", "none.csv"), Contains("none.csv: cannot be read; region.table"));
  for (const auto& told : {grains_told("1,9,0.1\n", "table =", "tabel ="),
                           told_of(rocks_in_plane, {{"region.0.porosity=0.4"}, "", "", {}})}) {
    CHECK_THAT(told, Contains("region.porosity is of a table of grains or of saturated soil; give table"));
  }
  CHECK_THAT(grains_told("1,9,0.1\n", "contact = \"ghost\"", "contact = \"ghost\"\nporosity = 0.4"),
             Contains("rock_soil.porosity is of points that fill a box"));
  CHECK_THAT(grains_told("1,9,0.1\n", "table = \"fine.csv\"", "table = 5"), Contains("region.table"));
  const std::string box =
      "[[region]]\nmaterial = \"soil\"\nlower_m = [0, 8.5]\nupper_m = [2, 9.5]\n[[region]]\nmaterial = \"soil\"\ntable";
  CHECK_THAT(grains_told("1,9,0.1\n", "[[region]]\nmaterial = \"soil\"\ntable", box),
             Contains("would fill that place twice"));
  CHECK(grains_told("1,7,0.1\n", "[[region]]\nmaterial = \"soil\"\ntable", box) == "accepted");
}

TEST_CASE("a run leaves tables of its rocks, from which another one goes on") {
  const std::string drawn =
      "[[rocks]]\nname = \"discs\"\nmaterial = \"basalt\"\nlower_m = [0, 0]\nupper_m = [2, 1]\nvolume_share = 0.2\n"
      "diameters_m = [[0.3, 1]]\n[[rocks]]\nname = \"slabs\"\nmaterial = \"basalt\"\nlower_m = [0, 1]\nupper_m = [2, "
      "2]\n"
      "volume_share = 0.2\ndiameters_m = [[0.3, 1]]\naspect = [2, 1]\nblockiness = [4]\n";
  const std::string from_tables =
      "[[rocks]]\nname = \"discs\"\nmaterial = \"basalt\"\ntable = \"first/rocks_discs.csv\"\n[[rocks]]\nname = "
      "\"slabs\"\nmaterial = \"basalt\"\ntable = \"first/rocks_slabs.csv\"\nblockiness = [4]\n";
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
