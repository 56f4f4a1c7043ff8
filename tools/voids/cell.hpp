// The periodic cell of the grains.
#pragma once

#include <Eigen/Core>
#include <array>

namespace rvelab::voids {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Image = std::array<int, 3>;  ///< integer coordinates of a lattice translation

/// Its vectors are the columns of the lattice, upper triangular, m; in the plane the third is (0, 0, thickness).
struct PeriodicCell {
  int dimension = 3;
  Matrix3 lattice = Matrix3::Identity();

  double volume() const { return lattice.diagonal().prod(); }  ///< m^3
  Vector3 translation(const Image& image) const { return lattice * Vector3(image[0], image[1], image[2]); }
};

}  // namespace rvelab::voids
