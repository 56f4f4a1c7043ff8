// Reduction of the lattice: the same lattice, in its shortest basis.
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "tests/catch.hpp"
#include "tests/cell/random_cells.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

// The cell of random_cell in a basis that hides it.
Cell skewed(Generator& generator, const Cell& cell, int additions) {
  const Eigen::Matrix3i basis = random_unimodular(generator, cell.dimension, additions);
  return cell_of(cell.dimension, cell.lattice * basis.cast<double>());
}

// No basis vector can be shortened by the others, by brute force over coordinates up to 2.
bool is_minkowski_reduced(const Cell& cell) {
  const int depth = cell.dimension == 3 ? 2 : 0;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      for (int k = -depth; k <= depth; ++k) {
        const double length = (cell.lattice * Vector3(i, j, k)).norm() * (1 + 1e-9);
        const int coordinates[3] = {i, j, k};
        for (int m = 0; m < cell.dimension; ++m)
          if (std::abs(coordinates[m]) == 1) {
            // Replacing vector m by this one keeps a basis; vectors longer than m may not take part.
            bool shorter_only = true;
            for (int n = 0; n < cell.dimension; ++n)
              if (n != m && coordinates[n] != 0 && cell.lattice.col(n).norm() > cell.lattice.col(m).norm() * (1 + 1e-9))
                shorter_only = false;
            if (shorter_only && length < cell.lattice.col(m).norm()) return false;
          }
      }
  return true;
}

void check_change_of_basis(const Cell& cell, const Reduction& reduction, double tolerance) {
  const Matrix3 basis = reduction.basis.cast<double>(), inverse = reduction.inverse_basis.cast<double>();
  REQUIRE(reduction.basis * reduction.inverse_basis == Eigen::Matrix3i::Identity());
  REQUIRE(std::round(basis.determinant()) == 1.0);
  REQUIRE(largest(reduction.rotation.transpose() * reduction.rotation - Matrix3::Identity()) < 2e-15);
  REQUIRE(reduction.rotation.determinant() > 0);
  REQUIRE(reduction.lattice(1, 0) == 0);
  REQUIRE(reduction.lattice(2, 0) == 0);
  REQUIRE(reduction.lattice(2, 1) == 0);
  REQUIRE(reduction.lattice.diagonal().minCoeff() > 0);
  const double scale = largest(cell.lattice) * std::max(largest(basis), largest(inverse));
  REQUIRE(largest(reduction.rotation.transpose() * cell.lattice * basis - reduction.lattice) < tolerance * scale);
  REQUIRE(largest(reduction.rotation * reduction.lattice * inverse - cell.lattice) < tolerance * scale);
}

void check_untouched(const Cell& cell) {
  const Reduction reduction = reduced(cell);
  REQUIRE_FALSE(reduction.changed);
  REQUIRE(same_bits(reduction.lattice, cell.lattice));
  REQUIRE(same_bits(reduction.rotation, Matrix3::Identity()));
  REQUIRE(reduction.basis == Eigen::Matrix3i::Identity());
  REQUIRE(reduction.inverse_basis == Eigen::Matrix3i::Identity());
  Cell applied = cell;
  apply_reduction(applied, reduction);
  REQUIRE(same_bits(applied.lattice, cell.lattice));
  REQUIRE(same_bits(applied.rotation, cell.rotation));
}

Cell slab(double ax, double bx, double by) {
  Cell cell;
  cell.dimension = 2;
  cell.lattice << ax, bx, 0, 0, by, 0, 0, 0, 0.1;
  return cell;
}

}  // namespace

TEST_CASE("The reduced basis spans the same lattice") {
  Generator generator(21);
  for (const int dimension : {2, 3})
    for (int k = 0; k < 3000; ++k) {
      Cell cell = skewed(generator, random_cell(generator, dimension), 8);
      cell.rotation = random_rotation(generator, dimension);
      const Reduction reduction = reduced(cell);
      check_change_of_basis(cell, reduction, 1e-14);
      Cell after = cell;
      apply_reduction(after, reduction);
      REQUIRE(after.volume() == Approx(cell.volume()).epsilon(1e-11));
      // In the laboratory the vectors are the old ones, recombined.
      const Matrix3 vectors = cell.rotation * cell.lattice * reduction.basis.cast<double>();
      REQUIRE(largest(after.rotation * after.lattice - vectors) < 1e-11);
    }
}

TEST_CASE("The reduced basis cannot be shortened") {
  Generator generator(22);
  for (const int dimension : {2, 3})
    for (int k = 0; k < 3000; ++k) {
      Cell cell = skewed(generator, random_cell(generator, dimension), 8);
      apply_reduction(cell, reduced(cell));
      REQUIRE(is_minkowski_reduced(cell));
      check_untouched(cell);
    }
}

TEST_CASE("The shortest vector is that of a search through all") {
  Generator generator(23);
  for (const int dimension : {2, 3})
    for (int k = 0; k < 1000; ++k) {
      const Cell cell = random_cell(generator, dimension);
      const double expected = brute_shortest(cell.lattice, dimension, 4);
      REQUIRE(shortest_vector(cell) == Approx(expected).epsilon(1e-14));
      REQUIRE(shortest_vector(skewed(generator, cell, 8)) == Approx(expected).epsilon(1e-10));
    }
}

TEST_CASE("The thickness of a slab is no lattice vector") {
  CHECK(shortest_vector(slab(2, 0, 3)) == 2);
  const Reduction reduction = reduced(slab(1, 7.3, 0.8));
  CHECK(reduction.changed);
  CHECK(reduction.lattice.col(2) == Vector3(0, 0, 0.1));
  CHECK(reduction.lattice(2, 0) == 0);
  CHECK(reduction.rotation.col(2) == Vector3(0, 0, 1));
  CHECK(reduction.basis.col(2) == Eigen::Vector3i(0, 0, 1));
}

TEST_CASE("A cell that is already reduced keeps its axes whatever the order of their lengths") {
  for (const double ax : {0.3, 1.0, 5.0})
    for (const double by : {0.3, 1.0, 5.0}) {
      check_untouched(slab(ax, 0.0, by));
      const double tilt = 0.49 * std::min(ax * ax, by * by) / ax;  // a.b below half the smaller square
      check_untouched(slab(ax, tilt, by));
      check_untouched(slab(ax, -tilt, by));
      for (const double cz : {0.3, 1.0, 5.0}) {
        Cell cell;
        cell.lattice = Vector3(ax, by, cz).asDiagonal();
        check_untouched(cell);
        cell.lattice(0, 1) = 0.004;
        cell.lattice(0, 2) = -0.003;
        cell.lattice(1, 2) = 0.002;
        check_untouched(cell);
      }
    }
}

TEST_CASE("Simple shear past one half is the known flip without a turn") {
  for (const double shear : {0.51, 0.9, 1.0, 1.49}) {
    const Reduction reduction = reduced(slab(1, shear, 1));
    REQUIRE(reduction.changed);
    Eigen::Matrix3i flip = Eigen::Matrix3i::Identity();
    flip(0, 1) = -1;
    CHECK(reduction.basis == flip);
    CHECK(same_bits(reduction.rotation, Matrix3::Identity()));
    CHECK(reduction.lattice(0, 1) == shear - 1);
    CHECK(reduction.lattice(0, 0) == 1);
    CHECK(reduction.lattice(1, 1) == 1);
  }
  Cell cell;  // 3D, v_x(z), backwards
  cell.lattice(0, 2) = -0.6;
  const Reduction reduction = reduced(cell);
  CHECK(reduction.basis.col(2) == Eigen::Vector3i(1, 0, 1));
  CHECK(same_bits(reduction.rotation, Matrix3::Identity()));
  CHECK(reduction.lattice.diagonal() == Vector3(1, 1, 1));
  check_untouched(slab(1, 0.49, 1));
  check_untouched(slab(1, -0.49, 1));
}

TEST_CASE("Ties do not swap") {
  const double root3 = std::sqrt(3.0);
  // Half-sheared square, hexagonal lattice, and both a few rounding steps to either side.
  for (const double tilt : {0.5, -0.5})
    for (const double height : {1.0, root3 / 2})
      for (const double disturbance : {0.0, 1e-16, -1e-16, 1e-12, -1e-12, 1e-11, -1e-11})
        check_untouched(slab(1, tilt + disturbance, height));
  // Face-centred cubic, body-centred cubic and hexagonal bases, columns scaled so that rounding takes part.
  Matrix3 fcc, bcc, hexagonal;
  fcc << 0, 1, 1, 1, 0, 1, 1, 1, 0;
  bcc << -1, 1, 1, 1, -1, 1, 1, 1, -1;
  hexagonal << 1, 0.5, 0, 0, root3 / 2, 0, 0, 0, 1;
  Generator generator(24);
  for (Matrix3 basis : {fcc, bcc, hexagonal}) {
    for (int k = 0; k < 500; ++k) {
      const double scale = uniform(generator, 0.1, 10);
      const Cell primitive = cell_of(3, scale * basis);
      REQUIRE(primitive.lattice.diagonal().minCoeff() > 0);
      const double expected = brute_shortest(primitive.lattice, 3, 4);
      Cell cell = skewed(generator, primitive, 8);
      apply_reduction(cell, reduced(cell));
      REQUIRE(is_minkowski_reduced(cell));
      REQUIRE(shortest_vector(cell) == Approx(expected).epsilon(1e-9));
      check_untouched(cell);
    }
    check_untouched(cell_of(3, basis));
  }
}

TEST_CASE("A cell sheared a million times over is found again") {
  const double shear = 1e6 + 0.25;
  const Reduction reduction = reduced(slab(1, shear, 1));
  CHECK(reduction.basis(0, 1) == -1000000);
  CHECK(reduction.lattice(0, 1) == 0.25);
  Cell cell;
  cell.lattice << 1, 3e4, -7e4, 0, 1, 2e4, 0, 0, 1;
  Cell cubic = cell;
  apply_reduction(cubic, reduced(cell));
  CHECK(largest(cubic.lattice - Matrix3::Identity()) < 1e-9);
}

TEST_CASE("A degenerate lattice is an error") {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    CHECK_THROWS_AS(reduced(slab(bad, 0, 1)), Error);
    CHECK_THROWS_AS(shortest_vector(slab(1, 0, bad)), Error);
  }
  CHECK_THROWS_AS(reduced(slab(1, std::nan(""), 1)), Error);
  CHECK_THROWS_AS(reduced(slab(1, 1e15, 1)), Error);      // integers beyond int
  CHECK_THROWS_AS(reduced(slab(1, 0.3, 1e-300)), Error);  // flat to round-off
  Cell lower;
  lower.lattice(1, 0) = 0.1;
  CHECK_THROWS_AS(reduced(lower), Error);
}

TEST_CASE("The shear that makes a cell thin is that from which on a height of the reduced cell is below the limit") {
  const double limit = 4;
  for (const int dimension : {2, 3}) {
    const Cell upright = cubic_cell(dimension, std::pow(20.0, dimension), 1);
    const int k = dimension - 1;
    CHECK(shear_until_thin(upright, 0, k, limit, 1e4) > 1e4);
    Cell skewed = upright;  // a1 along x is enough
    skewed.lattice(0, k) = 3.7;
    CHECK(shear_until_thin(skewed, 0, k, limit, 1e4) > 1e4);
    CHECK(shear_until_thin(upright, 0, k, 30, 1e4) == 0);
    for (const double turn : {2.5e-3, 0.05, -0.3}) {
      Cell turned = upright;
      const double c = std::cos(turn), s = std::sin(turn);
      turned.rotation(0, 0) = turned.rotation(k, k) = c;
      turned.rotation(0, k) = -s;
      turned.rotation(k, 0) = s;
      const double thin = shear_until_thin(turned, 0, k, limit, 1e4);
      CAPTURE(dimension, turn, thin);
      const auto least_height = [&](double gamma) {
        Matrix3 shear = Matrix3::Zero();
        shear(0, k) = gamma;
        Cell cell = cell_of(dimension, (Matrix3::Identity() + shear) * turned.rotation * turned.lattice);
        apply_reduction(cell, reduced(cell));
        return heights(cell).minCoeff();
      };
      double least = 1e300;
      for (const double sign : {1.0, -1.0})
        for (double gamma = 0.01; gamma < 400; gamma += 0.01) {
          if (gamma < least && least_height(sign * gamma) < limit) least = gamma;
        }
      CHECK(thin == Approx(least).epsilon(0.02).margin(0.06));
    }
  }
}
