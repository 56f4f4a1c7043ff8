// Long flows: what reduction and an oriented start do for the cell (Kraynik and Reinelt 1992).
#include <cmath>

#include "rvelab/error.hpp"
#include "tests/catch.hpp"
#include "tests/cell/random_cells.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

void advance(Cell& cell, const Matrix3& gradient) {
  const FrameSplit split = split_increment(cell, gradient);
  cell.lattice = (split.stretch * cell.lattice).eval();
  turn_frame(cell, split.rotation);
  apply_reduction(cell, reduced(cell));
}

double size_of(const Cell& cell) {
  return cell.dimension == 2 ? std::sqrt(cell.volume() / cell.lattice(2, 2)) : std::cbrt(cell.volume());
}

double compactness(const Cell& cell) { return shortest_vector(cell) / size_of(cell); }

Matrix3 simple_shear(int gradient_axis, double strain) {
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, gradient_axis) = strain;
  return gradient;
}

// Increment of a diagonal flow of constant volume; rates add up to zero.
Matrix3 diagonal_flow(const Vector3& hencky) {
  return Vector3(std::expm1(hencky[0]), std::expm1(hencky[1]), std::expm1(hencky[2])).asDiagonal();
}

// Least compactness on the way to a Hencky strain of 10 along `rates`, in steps of 0.01.
double least_compactness(Cell cell, const Vector3& rates) {
  const double volume = cell.volume();
  double least = compactness(cell);
  for (int k = 0; k < 1000; ++k) {
    advance(cell, diagonal_flow(0.01 * rates));
    least = std::min(least, compactness(cell));
  }
  CHECK(cell.volume() == Approx(volume).epsilon(1e-10));
  return least;
}

}  // namespace

TEST_CASE("Simple shear along a cell vector to strain 1000 keeps the cell compact and its volume") {
  for (const int dimension : {2, 3}) {
    Cell cell = cubic_cell(dimension, 3.7, 0.1);
    const double volume = cell.volume();
    const Matrix3 gradient = simple_shear(dimension - 1, 0.05);
    double least = compactness(cell);
    for (int k = 0; k < 20000; ++k) {
      advance(cell, gradient);
      least = std::min(least, compactness(cell));
    }
    CHECK(least >= 0.7);
    CHECK(least == Approx(1.0).epsilon(1e-9));  // the cell vector itself stays the shortest
    CHECK(cell.volume() == Approx(volume).epsilon(1e-10));
    CHECK(largest(cell.rotation - Matrix3::Identity()) < 1e-12);
    // A whole number of flips: the cell is where it was, to the round-off of 20,000 increments.
    CHECK(cell.lattice(0, dimension - 1) == Approx(0).margin(1e-9 * size_of(cell)));
  }
}

TEST_CASE("Simple shear along the diagonal of a square cell stays at one over root two") {
  Cell cell = cubic_cell(2, 1.0, 1.0);
  Matrix3 gradient = Matrix3::Zero();
  gradient.topLeftCorner<2, 2>() << -0.5, 0.5, -0.5, 0.5;  // along (1, 1), strain one
  double least = 1;
  for (int k = 0; k < 2000; ++k) {
    advance(cell, 0.01 * gradient);
    least = std::min(least, compactness(cell));
  }
  CHECK(least >= 0.7);
  CHECK(least == Approx(std::sqrt(0.5)).epsilon(1e-4));  // reached where a diagonal is met at half its period
}

TEST_CASE("A reversed shear comes back to the cell it left") {
  Cell cell = cubic_cell(3, 1.0);
  for (const double sign : {1.0, -1.0})
    for (int k = 0; k < 345; ++k) advance(cell, simple_shear(1, sign * 0.01));
  CHECK(largest(cell.lattice - Matrix3::Identity()) < 1e-12);
  CHECK(same_bits(cell.rotation, Matrix3::Identity()));
}

TEST_CASE("The Kraynik-Reinelt start keeps a cell compact under planar pure shear") {
  const double bound = std::sqrt(2.0) / std::pow(5.0, 0.25);  // 0.9457
  for (const double sign : {1.0, -1.0}) {
    const double least = least_compactness(kraynik_reinelt_cell(2.0, 0.1), Vector3(sign, -sign, 0));
    CHECK(least >= 0.94);
    CHECK(least == Approx(bound).epsilon(1e-4));
  }
}

TEST_CASE("An axis-aligned cell becomes slender under planar pure shear whatever its basis") {
  Cell cell = cubic_cell(2, 2.0, 0.1);
  for (int k = 1; k <= 300; ++k) {
    advance(cell, diagonal_flow(Vector3(0.01, -0.01, 0)));
    REQUIRE(compactness(cell) == Approx(std::exp(-0.01 * k)).epsilon(1e-10));
  }
}

TEST_CASE("The cubic-field start keeps a cell compact under every diagonal flow") {
  const double bound = std::sqrt(3.0) / std::cbrt(7.0);  // 0.9054
  for (const Vector3& rates : {Vector3(1, -0.5, -0.5), Vector3(-0.5, 1, -0.5), Vector3(-0.5, -0.5, 1)})
    for (const double sign : {1.0, -1.0}) {
      const double least = least_compactness(cubic_field_cell(2.0), sign * rates);
      CHECK(least >= 0.9);
      CHECK(least >= bound * (1 - 1e-5));
    }
  CHECK(least_compactness(cubic_field_cell(2.0), Vector3(1, -1, 0)) >= bound * (1 - 1e-5));
}

TEST_CASE("The cubic-field lattice is that of 1 and rho and its square") {
  // Up to scale the norm form, the product of a vector's laboratory coordinates, takes integer values only.
  const Cell cell = cubic_field_cell(7.0);
  const Matrix3 vectors = cell.rotation * cell.lattice;
  bool found_unit = false;
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      for (int k = -3; k <= 3; ++k) {
        const double norm = (vectors * Vector3(i, j, k)).prod();
        REQUIRE(std::abs(norm - std::round(norm)) < 1e-11);
        if (i != 0 || j != 0 || k != 0) REQUIRE(std::abs(norm) > 0.5);
        found_unit = found_unit || std::abs(std::abs(norm) - 1) < 1e-11;
      }
  CHECK(found_unit);
}

TEST_CASE("Starting cells have the volume asked for and a proper frame") {
  for (const double volume : {1e-9, 0.02, 0.5, 1.0, 7.5, 8.0, 1e6}) {
    for (const Cell& cell : {cubic_cell(2, volume, 0.1), cubic_cell(3, volume), kraynik_reinelt_cell(volume, 0.1),
                             cubic_field_cell(volume)}) {
      CHECK(cell.volume() == Approx(volume).epsilon(1e-14));
      CHECK(largest(cell.rotation.transpose() * cell.rotation - Matrix3::Identity()) < 1e-15);
      CHECK(cell.rotation.determinant() == Approx(1).epsilon(1e-14));
      CHECK_FALSE(reduced(cell).changed);
      if (cell.dimension == 2) CHECK(cell.lattice(2, 2) == 0.1);
    }
    CHECK(cubic_cell(3, volume).lattice(0, 0) == Approx(std::cbrt(volume)).epsilon(4e-16));
  }
  const Matrix3 turned = kraynik_reinelt_cell(1, 1).rotation;
  CHECK(std::atan2(turned(1, 0), turned(0, 0)) * 180 / 3.14159265358979323846 == Approx(31.7175).epsilon(1e-6));
}

TEST_CASE("A start without volume is a user's mistake") {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    CHECK_THROWS_AS(cubic_cell(3, bad), InputError);
    CHECK_THROWS_AS(cubic_cell(2, 1.0, bad), InputError);
    CHECK_THROWS_AS(kraynik_reinelt_cell(bad, 1.0), InputError);
    CHECK_THROWS_AS(cubic_field_cell(bad), InputError);
  }
  CHECK_THROWS_AS(cubic_cell(4, 1.0), InputError);
}
