#include "rvelab/report/local_strain.hpp"

#include <Eigen/LU>
#include <cmath>

#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::report {
namespace {

using Matrices = std::vector<Matrix3>;

/// Adds to each grain the values of its neighbours.
Matrices with_neighbours(const Network& network, const Matrices& own) {
  Matrices sum = own;
  for (const ContactState& contact : network.contacts) {
    sum[std::size_t(contact.i)] += own[std::size_t(contact.j)];
    sum[std::size_t(contact.j)] += own[std::size_t(contact.i)];
  }
  return sum;
}

}  // namespace

Motion::Motion(const Network& first)
    : fluctuation(first.grains.size(), Vector3::Zero()),
      shear(first.grains.size(), ensemble::nan),
      volume(first.grains.size(), ensemble::nan) {}

void Motion::go_on(const Network& before, const Network& after, const Matrix3& deformation) {
  const std::size_t n = before.grains.size();
  const int d = before.dimension();
  const Matrix3 lattice = after.cell.rotation * after.cell.lattice, inverse = lattice.inverse();
  std::vector<Vector3> steps(n);
  Vector3 mean = Vector3::Zero();
  for (std::size_t g = 0; g < n; ++g) {
    const Vector3 moved = after.cell.rotation * after.grains[g].position -
                          deformation * (before.cell.rotation * before.grains[g].position);
    Vector3 cells = inverse * moved;
    for (int k = 0; k < 3; ++k) cells[k] = k < d ? std::round(cells[k]) : 0;
    steps[g] = moved - lattice * cells;
    mean += steps[g] / double(n);
  }
  // A drift of the whole cell is no strain.
  for (std::size_t g = 0; g < n; ++g) {
    steps[g] -= mean;
    fluctuation[g] = deformation * fluctuation[g] + steps[g];
  }
  Matrices gradient(n, Matrix3::Zero()), moment(n, Matrix3::Zero());
  for (const ContactState& contact : before.contacts) {
    const auto i = std::size_t(contact.i), j = std::size_t(contact.j);
    const Vector3 branch = before.cell.rotation * contact.branch;
    const Matrix3 difference = (steps[j] - steps[i]) * branch.transpose(), square = branch * branch.transpose();
    gradient[i] += difference, gradient[j] += difference;
    moment[i] += square, moment[j] += square;
  }
  gradient = with_neighbours(before, gradient), moment = with_neighbours(before, moment);
  const Matrix3 I = Matrix3::Identity();
  for (std::size_t g = 0; g < n; ++g) {
    shear[g] = volume[g] = ensemble::nan;
    Matrix3 square = moment[g];
    if (d == 2) square(2, 2) = 1;  // no motion out of the plane
    const double scale = moment[g].trace();
    // Branches along one line do not determine the strain across it.
    const double spread = square.determinant() / (d == 2 ? scale * scale : scale * scale * scale);
    if (!(scale > 0) || !(spread > 1e-4)) continue;
    const Matrix3 H = deformation - I + gradient[g] * square.inverse();
    const Matrix3 strain = 0.5 * (H + H.transpose());
    shear[g] = deviatoric_strain(strain, d);
    volume[g] = 1 - (I + H).determinant();
  }
}

}  // namespace rvelab::report
