// Random matrices and cells for the tests of this folder, made by other means than the code under test.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "rvelab/cell/cell.hpp"

namespace rvelab::test {

using Generator = std::mt19937_64;

inline double uniform(Generator& generator, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}

/// Entries in (-size, size); in 2D those of the third row and column are zero.
inline Matrix3 random_gradient(Generator& generator, int dimension, double size) {
  Matrix3 gradient = Matrix3::Zero();
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j < dimension; ++j) gradient(i, j) = uniform(generator, -size, size);
  return gradient;
}

/// Proper rotation, in 2D about z.
inline Matrix3 random_rotation(Generator& generator, int dimension) {
  Vector3 axis = Vector3::UnitZ();
  if (dimension == 3) {
    do axis = {uniform(generator, -1, 1), uniform(generator, -1, 1), uniform(generator, -1, 1)};
    while (axis.norm() < 0.1 || axis.norm() > 1.0);
  }
  return Eigen::AngleAxisd(uniform(generator, -3.14, 3.14), axis.normalized()).toRotationMatrix();
}

/// Upper triangular, diagonal in (0.8, 1.3), the rest in (-0.5, 0.5): lattice vectors no longer than the shortest
/// cell vector then have coordinates of at most 4.
inline Cell random_cell(Generator& generator, int dimension) {
  Cell cell;
  cell.dimension = dimension;
  for (int i = 0; i < dimension; ++i) {
    cell.lattice(i, i) = uniform(generator, 0.8, 1.3);
    for (int j = i + 1; j < dimension; ++j) cell.lattice(i, j) = uniform(generator, -0.5, 0.5);
  }
  if (dimension == 2) cell.lattice(2, 2) = 0.1;
  return cell;
}

/// Product of `count` random column additions: determinant one.
inline Eigen::Matrix3i random_unimodular(Generator& generator, int dimension, int count) {
  Eigen::Matrix3i result = Eigen::Matrix3i::Identity();
  std::uniform_int_distribution<int> vector(0, dimension - 1), multiple(-2, 2);
  for (int k = 0; k < count; ++k) {
    const int to = vector(generator), from = vector(generator);
    if (to != from) result.col(to) += multiple(generator) * result.col(from);
  }
  return result;
}

/// The cell whose vectors are the given columns (right-handed), by Gram-Schmidt orthogonalisation, made twice.
inline Cell cell_of(int dimension, const Matrix3& vectors) {
  Matrix3 rotation = vectors;
  for (int k = 0; k < 3; ++k) {
    for (int pass = 0; pass < 2; ++pass)
      for (int i = 0; i < k; ++i) rotation.col(k) -= rotation.col(i).dot(rotation.col(k)) * rotation.col(i);
    rotation.col(k).normalize();
  }
  Cell cell;
  cell.dimension = dimension;
  cell.lattice = (rotation.transpose() * vectors).triangularView<Eigen::Upper>();
  cell.rotation = rotation;
  return cell;
}

/// Length of the shortest vector among all coordinates up to `range`.
inline double brute_shortest(const Matrix3& lattice, int dimension, int range) {
  double least = 1e300;
  const int depth = dimension == 3 ? range : 0;
  for (int i = -range; i <= range; ++i)
    for (int j = -range; j <= range; ++j)
      for (int k = -depth; k <= depth; ++k)
        if (i != 0 || j != 0 || k != 0) least = std::min(least, (lattice * Vector3(i, j, k)).norm());
  return least;
}

inline bool same_bits(const Matrix3& a, const Matrix3& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

inline double largest(const Matrix3& m) { return m.cwiseAbs().maxCoeff(); }

}  // namespace rvelab::test
