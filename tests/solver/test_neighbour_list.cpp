// The neighbour list against brute force over images: correctness never rests on a compact cell.
#include "tests/solver/brute_force.hpp"

#include "tests/solver/generator.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

struct Cloud {
  Cell cell;
  std::vector<Vector3> positions;
  std::vector<double> radii;
};

/// Grains of radius 0.2 to 1 anywhere in a few periods of the cell (2D: in its plane).
Cloud cloud(Generator& generator, const Cell& cell, int grains) {
  Cloud c{cell, {}, {}};
  for (int g = 0; g < grains; ++g) {
    Vector3 s(uniform(generator, -1.6, 1.6), uniform(generator, -1.6, 1.6), uniform(generator, -1.6, 1.6));
    if (cell.dimension == 2) s[2] = 0;
    Vector3 x = cell.lattice * s;
    if (cell.dimension == 2) x[2] = 0;
    c.positions.push_back(x);
    c.radii.push_back(uniform(generator, 0.2, 1));
  }
  return c;
}

Cell cell_of(int dimension, double xx, double yy, double zz) {
  Cell cell;
  cell.dimension = dimension;
  cell.lattice = Vector3(xx, yy, zz).asDiagonal();
  return cell;
}

bool lists_equal(const Cloud& c, double skin) {
  return listed_pairs(c.cell, c.positions, c.radii, skin) == brute_force_pairs(c.cell, c.positions, c.radii, skin);
}

}  // namespace

TEST_CASE("the neighbour list is that of brute force over images in any lattice") {
  Generator generator(1);
  for (const int dimension : {2, 3})
    for (int trial = 0; trial < 300; ++trial) {
      Cell cell = cell_of(dimension, uniform(generator, 2, 12), uniform(generator, 2, 12), uniform(generator, 2, 12));
      for (int r = 0; r < dimension; ++r)
        for (int k = r + 1; k < dimension; ++k) cell.lattice(r, k) = uniform(generator, -2, 2) * cell.lattice(r, r);
      CAPTURE(dimension, trial);
      CHECK(lists_equal(cloud(generator, cell, 1 + trial % 25), uniform(generator, 0, 0.5)));
    }
}

TEST_CASE("the neighbour list is that of brute force in cells thinner than a grain") {
  Generator generator(2);
  for (const int dimension : {2, 3})
    for (int trial = 0; trial < 120; ++trial) {
      // One or two heights down to a twentieth of the largest diameter: dozens of images of one grain.
      double height[3] = {uniform(generator, 3, 8), uniform(generator, 3, 8), uniform(generator, 3, 8)};
      height[trial % dimension] = uniform(generator, 0.1, 1);
      if (trial % 3 == 0) height[(trial + 1) % dimension] = uniform(generator, 0.4, 1);
      Cell cell = cell_of(dimension, height[0], height[1], height[2]);
      for (int r = 0; r < dimension; ++r)
        for (int k = r + 1; k < dimension; ++k) cell.lattice(r, k) = uniform(generator, -3, 3);
      CAPTURE(dimension, trial);
      CHECK(lists_equal(cloud(generator, cell, 1 + trial % 6), 0.1));
    }
}

TEST_CASE("the neighbour list finds grains on faces, edges and corners of cell and bins") {
  Generator generator(3);
  for (const int dimension : {2, 3})
    for (int trial = 0; trial < 50; ++trial) {
      Cell cell = cell_of(dimension, 8, 8, 8);
      if (trial % 2 == 1) cell.lattice(0, 1) = 4;
      Cloud c{cell, {}, {}};
      for (int g = 0; g < 20; ++g) {
        // Multiples of a quarter of the cell, and one unit in the last place to either side.
        Vector3 x;
        for (int k = 0; k < 3; ++k) {
          const double at = 2 * std::floor(uniform(generator, -4, 5));
          const int side = int(std::floor(uniform(generator, 0, 3)));
          x[k] = side == 0 ? at : std::nextafter(at, side == 1 ? 1e9 : -1e9);
        }
        if (dimension == 2) x[2] = 0;
        c.positions.push_back(x);
        c.radii.push_back(uniform(generator, 0.2, 1));
      }
      CAPTURE(dimension, trial);
      CHECK(lists_equal(c, 0.05));
    }
}

TEST_CASE("the list of a cell with many grains is that of brute force") {
  Generator generator(4);
  for (const int dimension : {2, 3}) {
    Cell cell = cell_of(dimension, 23, 19, 14);
    for (int r = 0; r < dimension; ++r)
      for (int k = r + 1; k < dimension; ++k) cell.lattice(r, k) = 0.4 * cell.lattice(r, r);
    CHECK(lists_equal(cloud(generator, cell, 400), 0.2));
  }
}
