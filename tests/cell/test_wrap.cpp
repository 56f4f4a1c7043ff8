// Wrapping into the primary cuboid, lattice translations, heights.
#include <cmath>
#include <limits>

#include "rvelab/error.hpp"
#include "tests/catch.hpp"
#include "tests/cell/random_cells.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

// A cell sheared far beyond its reduced form.
Cell sheared_cell(Generator& generator, int dimension) {
  Cell cell = random_cell(generator, dimension);
  for (int i = 0; i < dimension; ++i)
    for (int j = i + 1; j < dimension; ++j) cell.lattice(i, j) = uniform(generator, -4, 4);
  return cell;
}

Vector3 random_point(Generator& generator, int dimension, double reach) {
  Vector3 point = Vector3::Zero();
  for (int k = 0; k < dimension; ++k) point[k] = uniform(generator, -reach, reach);
  return point;
}

bool inside(const Cell& cell, const Vector3& point) {
  for (int k = 0; k < cell.dimension; ++k) {
    const double half = cell.lattice(k, k) / 2;
    if (!(point[k] >= -half && point[k] < half)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("Every point comes into the cuboid by a lattice vector") {
  Generator generator(11);
  for (const int dimension : {2, 3})
    for (const double reach : {0.5, 3.0, 100.0, 1e6})
      for (int k = 0; k < 5000; ++k) {
        const Cell cell = sheared_cell(generator, dimension);
        const Vector3 start = random_point(generator, dimension, reach);
        Vector3 point = start;
        const Image image = wrap(cell, point);
        REQUIRE(inside(cell, point));
        // Round-off is that of the coordinates on the way, which a sheared lattice makes larger than the start's.
        double way = reach;
        for (int i = 0; i < dimension; ++i) way = std::max(way, 5.0 * std::abs(image[i]));
        REQUIRE((start + translation(cell, image) - point).norm() < 1e-15 * 10 * way);
      }
}

TEST_CASE("A point inside the cuboid stays bit for bit") {
  Generator generator(12);
  for (const int dimension : {2, 3})
    for (int k = 0; k < 5000; ++k) {
      const Cell cell = sheared_cell(generator, dimension);
      Vector3 point = random_point(generator, dimension, 0.5);
      for (int i = 0; i < dimension; ++i) point[i] *= cell.lattice(i, i);
      const Vector3 start = point;
      REQUIRE(wrap(cell, point) == Image{0, 0, 0});
      REQUIRE(std::memcmp(&point, &start, sizeof point) == 0);
    }
}

TEST_CASE("Wrapping twice is wrapping once") {
  Generator generator(13);
  for (const int dimension : {2, 3})
    for (int k = 0; k < 5000; ++k) {
      const Cell cell = sheared_cell(generator, dimension);
      Vector3 point = random_point(generator, dimension, 50.0);
      wrap(cell, point);
      const Vector3 once = point;
      REQUIRE(wrap(cell, point) == Image{0, 0, 0});
      REQUIRE(std::memcmp(&point, &once, sizeof point) == 0);
    }
}

TEST_CASE("The images of the cuboid tile space") {
  // The cuboid has the volume of the cell; so it tiles if no two of its points are lattice equivalent, and if all
  // images of a point come back to the same one.
  Generator generator(14);
  for (const int dimension : {2, 3})
    for (int k = 0; k < 300; ++k) {
      const Cell cell = sheared_cell(generator, dimension);
      Vector3 point = random_point(generator, dimension, 0.49);
      for (int i = 0; i < dimension; ++i) point[i] *= cell.lattice(i, i);
      const int range = 6, depth = dimension == 3 ? range : 0;
      for (int a = -range; a <= range; ++a)
        for (int b = -range; b <= range; ++b)
          for (int c = -depth; c <= depth; ++c) {
            Vector3 image = point + translation(cell, {a, b, c});
            if (a != 0 || b != 0 || c != 0) REQUIRE_FALSE(inside(cell, image));
            REQUIRE(wrap(cell, image) == Image{-a, -b, -c});
            REQUIRE((image - point).norm() < 1e-13);
          }
    }
}

TEST_CASE("A point on an upper face belongs to the lower face") {
  Cell cell;
  cell.lattice << 2, 0.5, -0.25, 0, 1, 0.75, 0, 0, 4;
  Vector3 on_x(1, 0, 0), on_y(0, 0.5, 0), on_z(0, 0, 2), lower(-1, -0.5, -2);
  CHECK(wrap(cell, on_x) == Image{-1, 0, 0});
  CHECK(on_x == Vector3(-1, 0, 0));
  CHECK(wrap(cell, on_y) == Image{0, -1, 0});
  CHECK(on_y == Vector3(-0.5, -0.5, 0));
  CHECK(wrap(cell, on_z) == Image{0, 1, -1});  // z first moves y to -0.75, outside: y next
  CHECK(on_z == Vector3(0.75, 0.25, -2));
  CHECK(wrap(cell, lower) == Image{0, 0, 0});
}

TEST_CASE("A point one rounding step outside a face ends inside") {
  Generator generator(15);
  for (int k = 0; k < 5000; ++k) {
    const Cell cell = sheared_cell(generator, 3);
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        const double face = sign * cell.lattice(axis, axis) / 2;
        for (const double towards : {-10.0, 10.0, 0.0}) {
          Vector3 point = Vector3::Zero();
          point[axis] = std::nextafter(face, towards);
          const Vector3 start = point;
          const Image image = wrap(cell, point);
          REQUIRE(inside(cell, point));
          REQUIRE((start + translation(cell, image) - point).norm() < 1e-14);
        }
      }
  }
}

TEST_CASE("In 2D the third coordinate is never wrapped") {
  Generator generator(16);
  const Cell cell = random_cell(generator, 2);
  Vector3 point(7, -9, 123);
  const Image image = wrap(cell, point);
  CHECK(image[2] == 0);
  CHECK(point[2] == 123);
}

TEST_CASE("A lost point is an error") {
  Cell cell;
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e30, -3e9}) {
    Vector3 point(0, value, 0);
    CHECK_THROWS_AS(wrap(cell, point), Error);
  }
}

TEST_CASE("A lattice translation is the integer sum of the cell vectors") {
  Cell cell;
  cell.lattice << 2, 0.5, -0.25, 0, 1, 0.75, 0, 0, 4;
  CHECK(translation(cell, {3, -2, 1}) == Vector3(4.75, -1.25, 4));
  CHECK(translation(cell, {0, 0, 0}) == Vector3(0, 0, 0));
}

TEST_CASE("Heights are the distances between opposite faces") {
  // The rows of L^-1 are the face normals over the heights.
  Generator generator(17);
  for (int k = 0; k < 1000; ++k) {
    const Cell cell = sheared_cell(generator, 3);
    const Matrix3 inverse = cell.lattice.inverse();
    const Vector3 found = heights(cell);
    for (int i = 0; i < 3; ++i) REQUIRE(found[i] == Approx(1 / inverse.row(i).norm()).epsilon(1e-12));
  }
  Cell slab;
  slab.dimension = 2;
  slab.lattice << 2, 3, 0, 0, 4, 0, 0, 0, 0.1;  // |b| = 5
  CHECK(heights(slab)[0] == Approx(8.0 / 5.0).epsilon(1e-14));
  CHECK(heights(slab)[1] == 4);
  CHECK(heights(slab)[2] == std::numeric_limits<double>::infinity());
}
