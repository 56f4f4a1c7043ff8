// The box that grains are drawn in, and their stresses. Declared in export.hpp.
#include "rvelab/io/export/export.hpp"

#include <cmath>

namespace rvelab::io {

Box::Box(const Matrix3& lattice) : lattice_(lattice) {
  // The inverse of an upper triangular matrix, without Eigen's general one, which would leave round-off below the
  // diagonal.
  const auto& l = lattice;
  inverse_ << 1 / l(0, 0), -l(0, 1) / (l(0, 0) * l(1, 1)),
      (l(0, 1) * l(1, 2) - l(0, 2) * l(1, 1)) / (l(0, 0) * l(1, 1) * l(2, 2)),  //
      0, 1 / l(1, 1), -l(1, 2) / (l(1, 1) * l(2, 2)),                           //
      0, 0, 1 / l(2, 2);
}

Vector3 Box::wrapped(const Vector3& point) const {
  const Vector3 fraction = inverse_ * point;
  Vector3 cells;
  for (int k = 0; k < 3; ++k) cells[k] = std::floor(fraction[k] + 0.5);
  return cells.isZero(0) ? point : Vector3(point - lattice_ * cells);
}

Matrix3 within_tilt_limits(const Matrix3& lattice) {
  Matrix3 l = lattice;
  l.col(2) -= std::round(l(1, 2) / l(1, 1)) * l.col(1);
  l.col(2) -= std::round(l(0, 2) / l(0, 0)) * l.col(0);
  l.col(1) -= std::round(l(0, 1) / l(0, 0)) * l.col(0);
  return l;
}

std::vector<Matrix3> grain_stresses(const Network& network) {
  std::vector<Matrix3> stresses(network.grains.size(), Matrix3::Zero());
  for (const ContactState& c : network.contacts) {
    const auto i = std::size_t(c.i), j = std::size_t(c.j);
    stresses[i] -= c.force() * c.arm_i.transpose();  // the force on i is -F
    stresses[j] += c.force() * c.arm_j.transpose();
  }
  for (const InteractionState& c : network.interactions) {
    stresses[std::size_t(c.i)] -= c.force() * c.arm_i.transpose();
    stresses[std::size_t(c.j)] += c.force() * c.arm_j.transpose();
  }
  const double thickness = network.cell.lattice(2, 2);
  const Matrix3& turn = network.cell.rotation;
  for (std::size_t g = 0; g < stresses.size(); ++g) {
    const double volume = grain_volume(network.shape, network.grains[g].radius, thickness);
    stresses[g] = turn * stresses[g] * turn.transpose() / volume;
  }
  return stresses;
}

}  // namespace rvelab::io
