// The split of an increment into a turn of the frame and a stretch of the cell.
#include <cmath>
#include <limits>
#include <vector>

#include "rvelab/error.hpp"
#include "tests/catch.hpp"
#include "tests/cell/random_cells.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

const double epsilon = std::numeric_limits<double>::epsilon();

Cell turned_cell(Generator& generator, int dimension) {
  Cell cell = random_cell(generator, dimension);
  cell.rotation = random_rotation(generator, dimension);
  return cell;
}

// The proper rotations whose entries are 0 and +-1: 4 about z in 2D, 24 in 3D.
std::vector<Matrix3> quarter_turns(int dimension) {
  std::vector<Matrix3> turns;
  const int permutations[6][3] = {{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}};
  for (const auto& p : permutations)
    for (int signs = 0; signs < 8; ++signs) {
      Matrix3 turn = Matrix3::Zero();
      for (int k = 0; k < 3; ++k) turn(k, p[k]) = (signs >> k) & 1 ? -1.0 : 1.0;
      if (turn.determinant() > 0 && (dimension == 3 || turn(2, 2) == 1.0)) turns.push_back(turn);
    }
  return turns;
}

bool exact_zero_below_diagonal(const Matrix3& m) { return m(1, 0) == 0 && m(2, 0) == 0 && m(2, 1) == 0; }

void refuses(const Cell& cell, const Matrix3& gradient, const std::string& words) {
  CHECK_THROWS_AS(split_increment(cell, gradient), InvalidIncrement);
  CHECK_THROWS_WITH(split_increment(cell, gradient), Catch::Contains(words));
}

}  // namespace

TEST_CASE("Rotation times stretch gives back the deformation gradient in the cell frame") {
  Generator generator(1);
  for (const int dimension : {2, 3})
    for (const double size : {1e-8, 1e-3, 0.3})
      for (int k = 0; k < 2000; ++k) {
        const Cell cell = turned_cell(generator, dimension);
        const Matrix3 gradient = random_gradient(generator, dimension, size);
        const FrameSplit split = split_increment(cell, gradient);
        const Matrix3 expected = cell.rotation.transpose() * (Matrix3::Identity() + gradient) * cell.rotation;
        REQUIRE(largest(split.rotation * split.stretch - expected) < 2e-15);
        REQUIRE(largest(split.rotation.transpose() * split.rotation - Matrix3::Identity()) < 1e-15);
        REQUIRE(split.rotation.determinant() > 0);
        REQUIRE(split.stretch.diagonal().minCoeff() > 0);
        REQUIRE(exact_zero_below_diagonal(split.stretch));
        REQUIRE_FALSE(split.rigid);
      }
}

TEST_CASE("In an aligned frame rotation times stretch gives back I + dH to 1e-15") {
  Generator generator(2);
  for (const int dimension : {2, 3})
    for (int k = 0; k < 5000; ++k) {
      Cell cell;
      cell.dimension = dimension;
      const Matrix3 gradient = random_gradient(generator, dimension, 0.2);
      const FrameSplit split = split_increment(cell, gradient);
      REQUIRE(largest(split.rotation * split.stretch - Matrix3::Identity() - gradient) < 1e-15);
    }
}

TEST_CASE("In 2D the slab's normal is left exactly as it is") {
  Generator generator(3);
  for (int k = 0; k < 1000; ++k) {
    const Cell cell = turned_cell(generator, 2);
    Matrix3 gradient = random_gradient(generator, 2, 0.1);
    gradient(0, 2) = 1e-13;  // round-off of the caller
    gradient(2, 1) = -1e-13;
    gradient(2, 2) = 1e-13;
    const FrameSplit split = split_increment(cell, gradient);
    for (const Matrix3& m : {split.rotation, split.stretch}) {
      REQUIRE(m(2, 2) == 1.0);
      for (int i = 0; i < 2; ++i) REQUIRE((m(i, 2) == 0.0 && m(2, i) == 0.0));
    }
  }
}

TEST_CASE("The cell deforms alike whatever the laboratory frame and the superposed rotation") {
  Generator generator(4);
  for (const int dimension : {2, 3})
    for (int k = 0; k < 2000; ++k) {
      const Cell cell = turned_cell(generator, dimension);
      const Matrix3 gradient = random_gradient(generator, dimension, 0.2);
      const FrameSplit split = split_increment(cell, gradient);
      const Matrix3 turn = random_rotation(generator, dimension);

      Cell observed = cell;  // the same event seen from a turned laboratory
      observed.rotation = turn * cell.rotation;
      const FrameSplit seen = split_increment(observed, turn * gradient * turn.transpose());
      REQUIRE(largest(seen.stretch - split.stretch) < 5e-15);
      REQUIRE(largest(seen.rotation - split.rotation) < 5e-15);

      const Matrix3 superposed = turn * (Matrix3::Identity() + gradient) - Matrix3::Identity();
      const FrameSplit spun = split_increment(cell, superposed);
      REQUIRE(largest(spun.stretch - split.stretch) < 5e-15);
      REQUIRE(largest(cell.rotation * spun.rotation - turn * cell.rotation * split.rotation) < 5e-15);
    }
}

TEST_CASE("No deformation leaves stretch and frame exactly as they were") {
  Generator generator(5);
  for (const int dimension : {2, 3}) {
    const FrameSplit split = split_increment(turned_cell(generator, dimension), Matrix3::Zero());
    CHECK(split.rigid);
    CHECK(same_bits(split.stretch, Matrix3::Identity()));
    CHECK(same_bits(split.rotation, Matrix3::Identity()));
  }
}

TEST_CASE("A simple shear along the first cell vector does not turn the frame") {
  Cell cell;
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 1) = 0.3;
  gradient(0, 2) = -0.7;
  const FrameSplit split = split_increment(cell, gradient);
  CHECK(same_bits(split.rotation, Matrix3::Identity()));
  CHECK(same_bits(split.stretch, Matrix3::Identity() + gradient));
  CHECK_FALSE(split.rigid);
}

TEST_CASE("Quarter turns are exact and rigid and four of them are none") {
  for (const int dimension : {2, 3}) {
    const std::vector<Matrix3> turns = quarter_turns(dimension);
    REQUIRE(turns.size() == (dimension == 2 ? 4u : 24u));
    for (const Matrix3& start : turns)
      for (const Matrix3& turn : turns) {
        Cell cell;
        cell.dimension = dimension;
        cell.rotation = start;
        for (int k = 0; k < 12; ++k) {  // the order of every such turn divides 12
          const FrameSplit split = split_increment(cell, turn - Matrix3::Identity());
          REQUIRE(split.rigid);
          REQUIRE(same_bits(split.stretch, Matrix3::Identity()));
          REQUIRE(split.rotation == start.transpose() * turn * start);
          turn_frame(cell, split.rotation);
        }
        REQUIRE(cell.rotation == start);
      }
  }
}

TEST_CASE("A million rigid rotations never deform the cell and keep the frame orthogonal", "[slow]") {
  Generator generator(6);
  for (const int dimension : {2, 3}) {
    Cell cell = turned_cell(generator, dimension);
    double drift = 0;
    long deformed = 0;
    const int rotations = 500000;  // in each dimension
    for (int k = 0; k < rotations; ++k) {
      const Matrix3 turn = random_rotation(generator, dimension);
      const FrameSplit split = split_increment(cell, turn - Matrix3::Identity());
      if (!split.rigid) ++deformed;
      turn_frame(cell, split.rotation);
      drift = std::max(drift, largest(cell.rotation.transpose() * cell.rotation - Matrix3::Identity()));
    }
    CHECK(deformed == 0);
    CHECK(drift < 1e-14);
    CHECK(std::abs(cell.rotation.determinant() - 1) < 1e-14);
    CHECK(cell.increments == rotations % 100);
  }
}

TEST_CASE("Rotations of one axis add up in the frame") {
  Cell cell;
  const Vector3 axis = Vector3(1, -2, 0.5).normalized();
  const Matrix3 turn = Eigen::AngleAxisd(1e-3, axis).toRotationMatrix();
  for (int k = 0; k < 1000; ++k) turn_frame(cell, split_increment(cell, turn - Matrix3::Identity()).rotation);
  CHECK(largest(cell.rotation - Eigen::AngleAxisd(1.0, axis).toRotationMatrix()) < 1e-12);
}

TEST_CASE("A Newton step squares the distance from the orthogonal matrices") {
  Generator generator(7);
  const Matrix3 rotation = random_rotation(generator, 3);
  for (const double error : {1e-2, 1e-4, 1e-6}) {
    const Matrix3 disturbed = rotation * (Matrix3::Identity() + error * Matrix3::Ones());
    const Matrix3 corrected = renormalised(disturbed);
    CHECK(largest(corrected.transpose() * corrected - Matrix3::Identity()) < 10 * error * error);
    CHECK(largest(corrected - rotation) < 10 * error * error);  // the error was a stretch: the nearest is known
  }
}

TEST_CASE("The volume follows the product of the determinants over 1e5 increments") {
  Generator generator(8);
  for (const int dimension : {2, 3}) {
    Cell cell = turned_cell(generator, dimension);
    const double start = cell.volume();
    long double logarithm = 0;
    for (int k = 0; k < 100000; ++k) {
      const Matrix3 gradient = random_gradient(generator, dimension, 1e-3);
      logarithm +=
          std::log((Eigen::Matrix<long double, 3, 3>::Identity() + gradient.cast<long double>()).determinant());
      const FrameSplit split = split_increment(cell, gradient);
      cell.lattice = (split.stretch * cell.lattice).eval();
      turn_frame(cell, split.rotation);
    }
    const double expected = static_cast<double>(std::exp(logarithm));
    CHECK(std::abs(cell.volume() / start / expected - 1) < 1e-10);
    CHECK(exact_zero_below_diagonal(cell.lattice));
  }
}

TEST_CASE("The rigid limit is eight units of round-off") {
  Cell cell;
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 1) = 8 * epsilon;
  CHECK(split_increment(cell, gradient).rigid);
  gradient(0, 1) = 9 * epsilon;
  CHECK_FALSE(split_increment(cell, gradient).rigid);
}

TEST_CASE("Increments that are no deformation are refused") {
  Cell cell;
  Matrix3 gradient = Matrix3::Zero();
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()})
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        gradient.setZero();
        gradient(i, j) = value;
        refuses(cell, gradient, std::string("dH_") + "xyz"[i] + "xyz"[j]);
      }
  gradient.setZero();
  gradient(0, 0) = -1;  // flat
  refuses(cell, gradient, "det(I + dH) = 0");
  gradient(0, 0) = -2;  // mirrored
  refuses(cell, gradient, "det(I + dH) = -1");
  refuses(cell, Matrix3::Constant(1e200), "det(I + dH)");
  // The determinant is one, and yet the increment is none: the refusal names what is beyond the numbers.
  Matrix3 shear = Matrix3::Zero();
  shear(1, 0) = 1e200;
  refuses(cell, shear, "U_xx = inf");
  refuses(cell, shear, "entries of dH up to 1e+200");
  refuses(cell, -2 * Matrix3::Identity(), "det(I + dH) = -1");
}

TEST_CASE("A 2D cell refuses out-of-plane components beyond round-off") {
  Cell cell;
  cell.dimension = 2;
  for (int k = 0; k < 5; ++k) {
    const int i = k < 3 ? k : 2, j = k < 3 ? 2 : k - 3;
    Matrix3 gradient = Matrix3::Zero();
    gradient(0, 0) = 1e-2;  // allowed: 1e-12 + 1e-11
    gradient(i, j) = 1.0e-11;
    CHECK_NOTHROW(split_increment(cell, gradient));
    gradient(i, j) = -1.2e-11;
    refuses(cell, gradient, std::string("dH_") + "xyz"[i] + "xyz"[j]);
  }
}
