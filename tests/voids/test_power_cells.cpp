// Power cells: what is known of them in closed form, and by its definition, point by point.
#include "tools/voids/power_cells.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "tests/catch.hpp"

using namespace rvelab;
using namespace rvelab::voids;

namespace {

PeriodicCell cell_of(int dimension, const Matrix3& lattice) {
  PeriodicCell cell;
  cell.dimension = dimension;
  cell.lattice = lattice;
  return cell;
}

/// A lattice sheared far beyond reduction, so that the nearest copies are not those of the nearest images.
Matrix3 sheared(double xy, double xz, double yz) {
  Matrix3 lattice;
  lattice << 1.1, xy, xz, 0, 0.9, yz, 0, 0, 1.3;
  return lattice;
}

std::vector<Ball> random_balls(const PeriodicCell& cell, int count, double least, double most, unsigned seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&] { return double(engine() >> 11) * 0x1p-53; };
  std::vector<Ball> balls;
  for (int k = 0; k < count; ++k) {
    Vector3 at = cell.lattice * Vector3(uniform(), uniform(), cell.dimension == 3 ? uniform() : 0);
    wrap(Cell{cell.dimension, cell.lattice}, at);
    balls.push_back({at, least + (most - least) * uniform()});
  }
  return balls;
}

double sum_of(const PowerCells& cells) { return std::accumulate(cells.volume.begin(), cells.volume.end(), 0.0); }

/// The ball, of all copies, to which a point belongs.
std::size_t owner(const Copies& copies, const Vector3& point) {
  double least = std::numeric_limits<double>::infinity();
  std::size_t found = 0;
  for (std::size_t k = 0; k < copies.balls.size(); ++k) {
    const double power =
        (copies.balls[k].position - point).squaredNorm() - copies.balls[k].radius * copies.balls[k].radius;
    if (power < least) least = power, found = std::size_t(copies.corners[k].ball);
  }
  return found;
}

}  // namespace

TEST_CASE("power cells fill a sheared cell, whatever the sizes of the grains") {
  for (const int d : {2, 3}) {
    for (const double shear : {0.0, 0.5, 2.7}) {
      for (const double most : {0.02, 0.1, 0.3}) {
        CAPTURE(d, shear, most);
        PeriodicCell cell = cell_of(d, sheared(shear, d == 3 ? -0.6 * shear : 0, d == 3 ? 0.4 * shear : 0));
        const auto balls = random_balls(cell, 200, 0.01, most, 7);
        const PowerCells cells = power_cells(cell, balls);
        CHECK(std::abs(sum_of(cells) / cell.volume() - 1) < 1e-12);
        for (const double volume : cells.volume) CHECK(volume > -1e-15);
        // Euler's formula on a torus: V - E + F = 0, and three edges a triangle.
        if (d == 2) {
          const auto visible = std::count_if(cells.volume.begin(), cells.volume.end(), [](double v) { return v > 0; });
          CHECK(cells.simplices.size() == 2 * std::size_t(visible));
        }
      }
    }
  }
}

TEST_CASE("the share of points that are nearest to a grain in power is its cell's share of the volume") {
  for (const int d : {2, 3}) {
    const PeriodicCell cell = cell_of(d, sheared(1.4, d == 3 ? 0.5 : 0, d == 3 ? -0.7 : 0));
    const auto balls = random_balls(cell, 12, 0.02, 0.25, 3);
    const PowerCells cells = power_cells(cell, balls);
    const Copies copies = copies_within(cell, balls, 1.5);
    std::mt19937_64 engine(11);
    const auto uniform = [&] { return double(engine() >> 11) * 0x1p-53; };
    const int points = 20000;
    std::vector<int> hits(balls.size(), 0);
    for (int k = 0; k < points; ++k) {
      Vector3 at = cell.lattice * Vector3(uniform(), uniform(), d == 3 ? uniform() : 0);
      wrap(Cell{cell.dimension, cell.lattice}, at);
      ++hits[owner(copies, at)];
    }
    for (std::size_t k = 0; k < balls.size(); ++k) {
      CAPTURE(d, k);
      const double share = cells.volume[k] / cell.volume(), deviation = std::sqrt(share * (1 - share) / points);
      CHECK(std::abs(hits[k] / double(points) - share) <= 4 * deviation);
    }
  }
}

TEST_CASE("two grains of a row are parted by the planes of equal power, at their contact and across the gap") {
  const double r1 = 0.3, r2 = 0.15, d = r1 + r2, width = 1.0, height = 0.8, depth = 0.7;
  const auto balls = std::vector<Ball>{{{-0.2, 0, 0}, r1}, {{-0.2 + d, 0, 0}, r2}};
  const double gap = width - d;  // to the copy of the small one on the other side
  const double first = r1 + (gap * gap + r1 * r1 - r2 * r2) / (2 * gap);
  for (const int dimension : {2, 3}) {
    const PowerCells cells = power_cells(cell_of(dimension, Vector3(width, height, depth).asDiagonal()), balls);
    CHECK(cells.volume[0] == Approx(first * height * depth).epsilon(1e-13));
    CHECK(cells.volume[1] == Approx((width - first) * height * depth).epsilon(1e-13));
  }
}

TEST_CASE("a lone grain has the whole cell, and one within another none") {
  for (const int d : {2, 3}) {
    const PeriodicCell cell = cell_of(d, sheared(0.4, d == 3 ? 0.3 : 0, d == 3 ? 0.2 : 0));
    CHECK(power_cells(cell, {{{0.1, 0.2, 0}, 0.3}}).volume[0] == Approx(cell.volume()).epsilon(1e-13));
    const PowerCells two = power_cells(cell, {{{0.1, 0.2, 0}, 0.4}, {{0.12, 0.2, 0}, 0.01}});
    CHECK(two.volume[0] == Approx(cell.volume()).epsilon(1e-13));
    CHECK(two.volume[1] == 0);
  }
  CHECK_THROWS(power_cells(cell_of(2, Matrix3::Identity()), {}));
}

TEST_CASE("the cells of a crystal are equal, however its spheres lie on common spheres") {
  Matrix3 face_centred;  // columns: half of the diagonals of a cube's faces, in an upper triangular frame
  face_centred << 1, 0.5, 0.5, 0, std::sqrt(0.75), std::sqrt(1.0 / 12), 0, 0, std::sqrt(2.0 / 3);
  for (const Matrix3& primitive : {Matrix3(Matrix3::Identity()), face_centred}) {
    std::vector<Ball> balls;
    for (int x = 0; x < 3; ++x)
      for (int y = 0; y < 3; ++y)
        for (int z = 0; z < 3; ++z) balls.push_back({primitive * Vector3(x - 1, y - 1, z - 1), 0.5});
    const PeriodicCell cell = cell_of(3, 3 * primitive);
    for (const double volume : power_cells(cell, balls).volume)
      CHECK(volume == Approx(primitive.determinant()).epsilon(1e-10));
  }
}
