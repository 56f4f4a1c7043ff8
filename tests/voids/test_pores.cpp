// Pores of crystals, circles and spheres that touch others, Kozeny and Carman; and the program.
#include "tools/voids/pores.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tests/catch.hpp"
#include "tests/child.hpp"
#include "tests/folder.hpp"
#include "tests/reference_specimen.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::voids;

namespace {

const double pi = std::acos(-1.0);

/// 27 spheres of radius 0.5 that touch along the primitive vectors.
struct Crystal {
  PeriodicCell cell;
  std::vector<Ball> balls;

  explicit Crystal(const Matrix3& primitive) {
    cell.lattice = 3 * primitive;
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 3; ++y)
        for (int z = 0; z < 3; ++z) balls.push_back({primitive * Vector3(x - 1, y - 1, z - 1), 0.5});
  }
};

Matrix3 face_centred() {
  Matrix3 primitive;
  primitive << 1, 0.5, 0.5, 0, std::sqrt(0.75), std::sqrt(1.0 / 12), 0, 0, std::sqrt(2.0 / 3);
  return primitive;
}

auto count_of(const std::vector<Pore>& pores, double radius) {
  return std::count_if(pores.begin(), pores.end(),
                       [&](const Pore& pore) { return std::abs(pore.radius - radius) < 1e-8; });
}

std::vector<Ball> balls_of(const Specimen& specimen) {
  std::vector<Ball> balls;
  for (std::size_t k = 0; k < specimen.grains.size(); ++k)
    balls.push_back({specimen.grains.position[k], specimen.grains.radius[k]});
  return balls;
}

/// Gap of a sphere and the nearest of all copies, negative where it is cut; and how many it touches.
std::pair<double, int> nearest(const Copies& copies, const Pore& pore, double tolerance) {
  double least = 1e300;
  int touched = 0;
  for (const Ball& ball : copies.balls) {
    const double gap = (ball.position - pore.centre).norm() - ball.radius - pore.radius;
    least = std::min(least, gap);
    touched += std::abs(gap) < tolerance;
  }
  return {least, touched};
}

}  // namespace

TEST_CASE("holes of a face-centred crystal: one of six corners and two of four for each sphere, eight windows") {
  const Crystal crystal(face_centred());
  const PowerCells cells = power_cells(crystal.cell, crystal.balls);
  const Pores found = pores(crystal.cell, crystal.balls, cells);
  CHECK(found.bodies.size() == 3 * 27);
  CHECK(count_of(found.bodies, 0.5 * (std::sqrt(2.0) - 1)) == 27);
  CHECK(count_of(found.bodies, 0.5 * (std::sqrt(1.5) - 1)) == 2 * 27);
  CHECK(found.throats.size() == 8 * 27);
  CHECK(count_of(found.throats, 0.5 * (2 / std::sqrt(3.0) - 1)) == 8 * 27);
  for (const double ratio : local_void_ratios(crystal.cell, crystal.balls, cells))
    CHECK(ratio == Approx(3 * std::sqrt(2.0) / pi - 1).epsilon(1e-9));
}

TEST_CASE("a simple cubic crystal has one hole a sphere, and three windows of four") {
  const Crystal crystal(Matrix3::Identity());
  const Pores found = pores(crystal.cell, crystal.balls, power_cells(crystal.cell, crystal.balls));
  CHECK(found.bodies.size() == 27);
  CHECK(count_of(found.bodies, 0.5 * (std::sqrt(3.0) - 1)) == 27);
  CHECK(count_of(found.throats, 0.5 * (std::sqrt(2.0) - 1)) == 3 * 27);
}

TEST_CASE("the ball between touching circles and spheres is that of Descartes and Soddy") {
  const std::vector<double> r{1, 1.0 / 2, 1.0 / 3};
  const double a = r[0] + r[1], b = r[0] + r[2], c = r[1] + r[2];
  const double x = (a * a + b * b - c * c) / (2 * a);
  Pore found;
  REQUIRE(touching_ball({{{0, 0, 0}, r[0]}, {{a, 0, 0}, r[1]}, {{x, std::sqrt(b * b - x * x), 0}, r[2]}}, found));
  CHECK(found.radius == Approx(1 / (1 + 2 + 3 + 2 * std::sqrt(1.0 * 2 + 2 * 3 + 3 * 1))).epsilon(1e-12));
  // Four touching spheres of one radius: k = 1 + sqrt(1.5) - ... of (sum k)^2 = 3 sum k^2, k_5 = 2 + sqrt(6).
  std::vector<Ball> spheres;
  for (const Vector3& at : {Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1), Vector3(-1, -1, 1)})
    spheres.push_back({at / std::sqrt(2.0), 1});
  REQUIRE(touching_ball(spheres, found));
  CHECK(found.radius == Approx(1 / (2 + std::sqrt(6.0))).epsilon(1e-12));
  CHECK(found.centre.norm() < 1e-14);
  REQUIRE(touching_ball({{{0, 0, 0}, 1}, {{0, 3.5, 0}, 2}}, found));  // half of the gap
  CHECK(found.radius == Approx(0.25));
}

TEST_CASE("pores of recorded packings touch as many grains as they need and are cut by none") {
  for (const char* name : {"dense_p20", "hertz"}) {
    const Specimen specimen = reference_specimen(name);
    const auto balls = balls_of(specimen);
    const int d = specimen.cell.dimension;
    const PeriodicCell cell{d, specimen.cell.lattice};
    const PowerCells cells = power_cells(cell, balls);
    const Pores found = pores(cell, balls, cells);
    const double r = balls[0].radius;
    const Copies copies = copies_within(cell, balls, 6 * r);
    CAPTURE(name, found.bodies.size(), found.throats.size(), cells.simplices.size());
    CHECK(found.bodies.size() > 0.8 * cells.simplices.size());
    for (std::size_t k = 0; k < found.bodies.size(); k += 7) {
      const auto [gap, touched] = nearest(copies, found.bodies[k], 2e-6 * r);
      CHECK(gap > -4e-6 * r);
      CHECK(touched >= d + 1);
    }
    for (std::size_t k = 0; k < found.throats.size(); k += 7) {
      const auto [gap, touched] = nearest(copies, found.throats[k], 2e-6 * r);
      CHECK(gap > -4e-6 * r);
      CHECK(touched >= d);
    }
  }
}

TEST_CASE("permeability of spheres of one size is d^2 n^3/(180 (1 - n)^2)") {
  const double d = 2e-3, n = 0.4, e = n / (1 - n);
  CHECK(specific_surface({{{0, 0, 0}, d / 2}, {{1, 0, 0}, d / 2}}, 3) == Approx(6 / d));
  CHECK(specific_surface({{{0, 0, 0}, d / 2}}, 2) == Approx(4 / d));
  CHECK(kozeny_carman(e, 6 / d) == Approx(d * d * n * n * n / (180 * (1 - n) * (1 - n))));
}

TEST_CASE("rvelab-voids prints what fills the cell, writes its tables, and refuses ellipses") {
  const rvelab::test::Folder folder;
  const Specimen specimen = reference_specimen("dense_p20");
  io::write_specimen(specimen, folder / "S.h5");
  const auto run = [&](const std::string& words) {
    const std::string command =
        std::string(RVELAB_VOIDS_PROGRAM) + " " + words + " >" + (folder / "out") + " 2>" + (folder / "err");
    return WEXITSTATUS(std::system(command.c_str()));
  };
  REQUIRE(run((folder / "S.h5") + " --json -o " + (folder / "v")) == 0);
  const auto json = nlohmann::json::parse(rvelab::test::bytes_of(folder / "out"));
  CHECK(std::abs(json.at("cells_over_volume_less_1").get<double>()) < 1e-10);
  CHECK(json.at("body_radius_50_percent_m").get<double>() > json.at("throat_radius_50_percent_m").get<double>());
  const std::string table = rvelab::test::bytes_of(folder / "v.cells.csv");
  CHECK(std::size_t(std::count(table.begin(), table.end(), '\n')) == 1 + specimen.grains.size());
  CHECK(run((folder / "S.h5") + " -o " + (folder / "v")) == 2);  // the tables are there
  Specimen ellipses = rvelab::test::empty_specimen(Shape::ellipse, 10, rvelab::test::linear_material(1e6, 1e6, 0.5));
  rvelab::test::add_ellipse(ellipses, {0, 0, 0}, 1, 0.5, 0);
  io::write_specimen(ellipses, folder / "E.h5");
  CHECK(run(folder / "E.h5") == 2);
  CHECK(rvelab::test::bytes_of(folder / "err").find("ellipses") != std::string::npos);
}

TEST_CASE("The program refuses a specimen that is none by its field, and prints what it was given as letters") {
  const rvelab::test::Folder folder;
  const Specimen good = reference_specimen("dense_p20");
  const auto refusal = [&](const std::string& words) {
    rvelab::test::Child child({RVELAB_VOIDS_PROGRAM, words, "-o", folder / "v"}, folder / "out", folder / "err");
    CHECK(child.wait() == 2);
    CHECK(!std::filesystem::exists(folder / "v.cells.csv"));
    return rvelab::test::bytes_of(folder / "err");
  };
  const auto refused = [&](auto edit) {
    Specimen bad = good;
    edit(bad);
    io::write_specimen(bad, folder / "S.h5");
    return refusal(folder / "S.h5");
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(refused([](Specimen& s) { s.cell.lattice(0, 0) = std::nan(""); }),
             Contains("S.h5: /cell/lattice_m[0, 0] = nan"));
  CHECK_THAT(refused([](Specimen& s) { s.cell.lattice(0, 1) = 1e6 * s.cell.lattice(0, 0); }),
             Contains("/cell/lattice_m[0, 1]"));
  CHECK_THAT(refused([](Specimen& s) { s.grains.radius[2] *= -1; }), Contains("/grains/radius_m[2] of grain"));
  for (const std::size_t length : {0, 200, 9000}) {
    const std::string said = refusal("a\x1b[31m\xff" + std::string(length, 'x'));
    CHECK_THAT(said, Contains("rvelab-voids: a?[31m?") && Contains("; give the path"));
    CHECK(std::count_if(said.begin(), said.end(), [](char c) { return c < ' ' || c > '~'; }) ==
          1);  // the end of the line
    CHECK(said.find(std::string(81, 'x')) == std::string::npos);
  }
}
