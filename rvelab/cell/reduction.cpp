// Reduction of the lattice basis: Lagrange-Gauss in 2D, Semaev's greedy algorithm in 3D.
//
// Sources: I. Semaev, A 3-dimensional lattice reduction algorithm, CaLC 2001; P. Nguyen and D. Stehle,
// Low-dimensional lattice basis reduction revisited, ACM Trans. Algorithms 5 (2009).
//
// Vectors are shortened in place, the longer by the shorter, never reordered: every step adds multiples of other
// basis vectors, so det N = +1 throughout, and a cell whose basis is reduced in some order keeps its axes. A vector is
// replaced only by one shorter by more than the tolerance, so that ties at one half terminate. Declared in cell.hpp.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"

namespace rvelab {
namespace {

using IntegerMatrix = Eigen::Matrix<std::int64_t, 3, 3>;

constexpr double tolerance = 1e-10;          // relative, of squared lengths
constexpr int most_steps = 1000;             // each step removes a fixed fraction of a skew of at most 2^31: some tens
constexpr double least_orthogonality = 0.7;  // V / product of lengths: sqrt(3)/2 in 2D, 1/sqrt(2) in 3D (fcc)

[[noreturn]] void refuse(const Matrix3& lattice, const std::string& reason) {
  char found[160];
  std::snprintf(found, sizeof found, "Lxx = %.6g, Lyy = %.6g, Lzz = %.6g, Lxy = %.6g, Lxz = %.6g, Lyz = %.6g m",
                lattice(0, 0), lattice(1, 1), lattice(2, 2), lattice(0, 1), lattice(0, 2), lattice(1, 2));
  throw CellError("degenerate lattice (" + std::string(found) + "): " + reason);
}

void check_lattice(const Matrix3& lattice) {
  if (!lattice.allFinite()) refuse(lattice, "every entry must be finite; check the cell that was read");
  if (!(lattice.diagonal().minCoeff() > 0.0))
    refuse(lattice, "the diagonal must be > 0; give three independent cell vectors in right-handed order");
  if (lattice(1, 0) != 0.0 || lattice(2, 0) != 0.0 || lattice(2, 1) != 0.0)
    refuse(lattice, "entries below the diagonal must be zero; rotate the lattice into its cell frame");
}

// A basis of the lattice L, as integers N and as vectors L N; always computed from L, so that no error adds up.
struct Basis {
  const Matrix3& lattice;
  IntegerMatrix integers = IntegerMatrix::Identity();
  Matrix3 vectors = lattice;
  bool changed = false;

  double dot(int i, int j) const { return vectors.col(i).dot(vectors.col(j)); }
  double squared(int i) const { return dot(i, i); }

  // Adds count times vector i to vector k.
  void add(int k, int i, double count) {
    constexpr double largest = std::numeric_limits<int>::max();
    if (std::abs(count) <= largest) integers.col(k) += static_cast<std::int64_t>(count) * integers.col(i);
    if (std::abs(count) > largest || integers.col(k).cwiseAbs().maxCoeff() > static_cast<std::int64_t>(largest))
      refuse(lattice, "its reduction needs integers beyond 2^31; apply smaller increments");
    vectors.col(k) = lattice * integers.col(k).cast<double>();
    changed = true;
  }
};

// Lagrange step: shortens vector k by a multiple of vector i. Returns whether it did.
bool shorten_by_vector(Basis& basis, int k, int i) {
  const double count = std::round(basis.dot(i, k) / basis.squared(i));
  const double before = basis.squared(k);
  const double after = (basis.vectors.col(k) - count * basis.vectors.col(i)).squaredNorm();
  if (count == 0.0 || !(after < (1.0 - tolerance) * before)) return false;
  basis.add(k, i, -count);
  return true;
}

// Shortens vector k by the closest vector of the plane lattice of i and j, which are reduced among themselves; then
// the closest vector's coordinates are within one of the rounded ones of the projection.
bool shorten_by_plane(Basis& basis, int k, int i, int j) {
  const double ii = basis.squared(i), jj = basis.squared(j), ij = basis.dot(i, j);
  const double ki = basis.dot(k, i), kj = basis.dot(k, j);
  const double determinant = ii * jj - ij * ij;
  const double centre_i = std::round((jj * ki - ij * kj) / determinant);
  const double centre_j = std::round((ii * kj - ij * ki) / determinant);
  double best = basis.squared(k), best_i = 0.0, best_j = 0.0;
  for (int step_i = -1; step_i <= 1; ++step_i)
    for (int step_j = -1; step_j <= 1; ++step_j) {
      const double count_i = centre_i + step_i, count_j = centre_j + step_j;
      const double squared =
          (basis.vectors.col(k) - count_i * basis.vectors.col(i) - count_j * basis.vectors.col(j)).squaredNorm();
      const bool shorter = squared < (1.0 - tolerance) * best;
      // Among equally short ones, the least change of basis.
      const bool as_short = squared <= (1.0 + tolerance) * best &&
                            std::abs(count_i) + std::abs(count_j) < std::abs(best_i) + std::abs(best_j);
      if (!shorter && !as_short) continue;
      best = squared;
      best_i = count_i;
      best_j = count_j;
    }
  if (best_i == 0.0 && best_j == 0.0) return false;
  if (best_i != 0.0) basis.add(k, i, -best_i);
  if (best_j != 0.0) basis.add(k, j, -best_j);
  return true;
}

// One step of the greedy algorithm; false when the basis is reduced.
bool shorten(Basis& basis, int dimension) {
  int order[3] = {0, 1, 2};  // by length; equal ones keep their order
  const auto sort_pair = [&](int p) {
    if (basis.squared(order[p + 1]) < basis.squared(order[p])) std::swap(order[p], order[p + 1]);
  };
  sort_pair(0);
  if (dimension == 3) {
    sort_pair(1);
    sort_pair(0);
  }
  if (shorten_by_vector(basis, order[1], order[0])) return true;
  return dimension == 3 && shorten_by_plane(basis, order[2], order[0], order[1]);
}

// Whether the basis has the orthogonality that a reduced one must have, and vectors well above the round-off of L N.
bool is_trustworthy(const Basis& basis, int dimension) {
  double lengths = dimension == 2 ? basis.lattice(2, 2) : 1.0;
  double shortest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < dimension; ++k) {
    const double length = std::sqrt(basis.squared(k));
    lengths *= length;
    if (length < shortest) shortest = length;
  }
  const double round_off = std::numeric_limits<double>::epsilon() *
                           (basis.lattice.cwiseAbs() * basis.integers.cast<double>().cwiseAbs()).maxCoeff();
  return basis.lattice.diagonal().prod() >= least_orthogonality * lengths && round_off <= 1e-3 * shortest;
}

// Inverse of an integer matrix of determinant one: its adjugate.
IntegerMatrix adjugate(const IntegerMatrix& m) {
  IntegerMatrix result;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int p = (j + 1) % 3, q = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
      result(i, j) = m(p, r) * m(q, s) - m(p, s) * m(q, r);
    }
  return result;
}

}  // namespace

Reduction reduced(const Cell& cell) {
  check_lattice(cell.lattice);
  Basis basis{cell.lattice};
  int steps = 0;
  while (steps < most_steps && shorten(basis, cell.dimension)) ++steps;

  if (steps == most_steps || !is_trustworthy(basis, cell.dimension))
    refuse(cell.lattice, "it is too skewed to be reduced in double precision; apply smaller increments");

  Reduction reduction;
  reduction.lattice = cell.lattice;
  if (!basis.changed) return reduction;
  const IntegerMatrix inverse = adjugate(basis.integers);
  if (inverse.cwiseAbs().maxCoeff() > std::numeric_limits<int>::max())
    refuse(cell.lattice, "its reduction needs integers beyond 2^31; apply smaller increments");
  const TriangularFactors factors = triangular_factors(basis.vectors);
  reduction.basis = basis.integers.cast<int>();
  reduction.inverse_basis = inverse.cast<int>();
  reduction.rotation = factors.rotation;
  reduction.lattice = factors.upper;
  reduction.changed = true;
  return reduction;
}

void apply_reduction(Cell& cell, const Reduction& reduction) {
  if (!reduction.changed) return;
  cell.lattice = reduction.lattice;
  turn_frame(cell, reduction.rotation);
}

double shear_until_thin(const Cell& cell, int i, int k, double least_height, double most) {
  double least = std::numeric_limits<double>::infinity();
  for (const double sign : {1.0, -1.0}) {
    Cell sheared = cell;
    double gamma = 0;
    apply_reduction(sheared, reduced(sheared));
    // A vector that short, of height y, stays short while the shear continues by more than least_height/y > 1.
    while (gamma < most && gamma < least && heights(sheared).minCoeff() >= least_height) {
      const double step = std::fmax(0.05, 0.005 * gamma);
      gamma += step;
      Matrix3 gradient = Matrix3::Zero();
      gradient(i, k) = sign * step;
      const FrameSplit split = split_increment(sheared, gradient);
      sheared.lattice = (split.stretch * sheared.lattice).eval();
      turn_frame(sheared, split.rotation);
      apply_reduction(sheared, reduced(sheared));
    }
    if (gamma < most) least = std::fmin(least, gamma);
  }
  return least;
}

double shortest_vector(const Cell& cell) {
  const Matrix3 lattice = reduced(cell).lattice;
  // The shortest vector of a reduced basis is a shortest one of the lattice, but for the tolerance: sums and
  // differences are checked too. One of each pair v, -v is sufficient.
  const int depth = cell.dimension == 3 ? 1 : 0;
  double least = std::numeric_limits<double>::infinity();
  for (int n2 = 0; n2 <= depth; ++n2)
    for (int n1 = -1; n1 <= 1; ++n1)
      for (int n0 = -1; n0 <= 1; ++n0) {
        if (n0 == 0 && n1 == 0 && n2 == 0) continue;
        const Vector3 vector = lattice * Vector3(n0, n1, n2);
        least = std::fmin(least, vector.squaredNorm());
      }
  return std::sqrt(least);
}

}  // namespace rvelab
