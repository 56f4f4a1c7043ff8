#include "rvelab/measure/anisotropy.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "rvelab/measure/deviator.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();  // a mean over nothing

/// Symmetric tensors of the plane or of space, orthonormal under A:B. The isotropic one is the last.
std::vector<Matrix3> orthonormal_tensors(int dimension) {
  std::vector<Matrix3> all;
  for (int i = 0; i < dimension; ++i) {
    for (int j = i + 1; j < dimension; ++j) {
      Matrix3 shear = Matrix3::Zero();
      shear(i, j) = shear(j, i) = std::sqrt(0.5);
      all.push_back(shear);
    }
  }
  all.push_back(Vector3(1, -1, 0).normalized().asDiagonal());
  if (dimension == 3) all.push_back(Vector3(1, 1, -2).normalized().asDiagonal());
  all.push_back(identity_in(dimension) / std::sqrt(dimension));
  return all;
}

/// Least squares of a field over the directions: the tensor A for which field(A, n) is nearest to value(contact), both
/// vectors, summed over the contacts. `tensors`: what A is made of. Where the normals leave a part of A open (those of
/// a square lattice), that part is zero.
template <class Field, class Value>
Matrix3 fitted(const Network& network, const std::vector<Matrix3>& tensors, const Field& field, const Value& value) {
  const auto size = static_cast<Eigen::Index>(tensors.size());
  Eigen::MatrixXd normal_equations = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  Eigen::Matrix3Xd columns(3, size);
  for (const ContactState& contact : network.contacts) {
    for (Eigen::Index k = 0; k < size; ++k) columns.col(k) = field(tensors[std::size_t(k)], contact.normal);
    normal_equations += columns.transpose() * columns;
    right += columns.transpose() * value(contact);
  }
  const Eigen::VectorXd parts = normal_equations.completeOrthogonalDecomposition().solve(right);
  Matrix3 sum = Matrix3::Zero();
  for (Eigen::Index k = 0; k < size; ++k) sum += parts[k] * tensors[std::size_t(k)];
  return sum;
}

/// (n.A n) n and A n - (n.A n) n.
Vector3 along_normal(const Matrix3& tensor, const Vector3& n) { return n.dot(tensor * n) * n; }
Vector3 across_normal(const Matrix3& tensor, const Vector3& n) { return tensor * n - along_normal(tensor, n); }

/// Mean and anisotropies of a vector at each contact, along and across the normal: mean (1 + n.a n), mean (a_t n -
/// ...).
struct Directional {
  double mean = 0;
  Matrix3 normal = Matrix3::Zero(), tangential = Matrix3::Zero();
};

template <class VectorAt>
Directional directional(const Network& network, const VectorAt& vector_at) {
  const int dimension = network.dimension();
  std::vector<Matrix3> tensors = orthonormal_tensors(dimension);
  const auto normal_part = [&](const ContactState& contact) {
    return Vector3(contact.normal.dot(vector_at(contact)) * contact.normal);
  };
  const Matrix3 a = fitted(network, tensors, along_normal, normal_part);
  tensors.pop_back();  // an isotropic tensor has no part across n
  const Matrix3 across_n = fitted(network, tensors, across_normal, [&](const ContactState& contact) {
    return Vector3(vector_at(contact) - normal_part(contact));
  });
  const double mean = a.trace() / dimension;
  if (!(mean > 0)) return {};
  return {mean, deviator(a, dimension) / mean, across_n / mean};
}

/// Amplitude of the fourth order: E:E of <n n n n> less the parts of lower order (Kanatani 1984).
double fourth_order_amplitude(const Network& network) {
  using Moments = Eigen::Matrix<double, 6, 6>;
  Moments fourth = Moments::Zero();
  for (const ContactState& contact : network.contacts) {
    const Vector3& n = contact.normal;
    Eigen::Matrix<double, 6, 1> squares;
    squares << n.cwiseProduct(n), std::sqrt(2) * n[1] * n[2], std::sqrt(2) * n[0] * n[2], std::sqrt(2) * n[0] * n[1];
    fourth += squares * squares.transpose();
  }
  fourth /= static_cast<double>(network.contacts.size());
  const double second = fabric(network).squaredNorm(), whole = fourth.squaredNorm();
  const bool plane = network.dimension() == 2;
  const double traceless = plane ? whole - second + 1.0 / 8 : whole - 6.0 / 7 * second + 3.0 / 35;
  return (plane ? std::sqrt(32.0) : 315.0 / 8 * std::sqrt(8.0 / 35)) * std::sqrt(std::max(traceless, 0.0));
}

}  // namespace

Anisotropies anisotropies(const Network& network) {
  if (network.contacts.empty()) {
    const Matrix3 none = Matrix3::Constant(nothing);
    return {none, none, none, none, none, nothing, nothing, nothing};
  }
  Anisotropies found;
  const int dimension = network.dimension();
  const Directional forces = directional(network, [](const ContactState& contact) { return contact.force(); });
  const Directional branches = directional(network, [](const ContactState& contact) { return contact.branch; });
  found.normals = (dimension == 2 ? 4 : 7.5) * deviator(fabric(network), dimension);
  found.normal_forces = in_laboratory(network, forces.normal);
  found.tangential_forces = in_laboratory(network, forces.tangential);
  found.branches = in_laboratory(network, branches.normal);
  found.tangential_branches = in_laboratory(network, branches.tangential);
  found.fourth_order = fourth_order_amplitude(network);
  found.mean_normal_force = forces.mean;
  found.mean_branch = branches.mean;
  return found;
}

double predicted_stress_ratio(const StressForceFabric& a, int dimension) {
  if (dimension == 3) return 0.4 * (a.a_c + a.a_n + a.a_l + 1.5 * (a.a_t + a.a_lt));
  const double products = a.a_c * a.a_n + a.a_c * a.a_l + a.a_n * a.a_l + a.a_t * a.a_lt;
  return 0.5 * (a.a_c + a.a_n + a.a_t + a.a_l + a.a_lt) / (1 + 0.5 * products);
}

StressForceFabric stress_force_fabric(const Network& network) {
  if (network.contacts.empty()) return {nothing, nothing, nothing, nothing, nothing, nothing, nothing};
  const int dimension = network.dimension();
  const Matrix3 stress = contact_stress(network), s = -deviator(stress, dimension);
  StressForceFabric found;
  const double p = mean_pressure(stress, dimension), size = s.norm();
  if (!(size > 0)) return found;
  const Anisotropies a = anisotropies(network);
  const auto amplitude = [&](const Matrix3& tensor) {
    return std::sqrt(dimension == 2 ? 0.5 : 1.5) * tensor.cwiseProduct(s).sum() / size;
  };
  found.a_c = amplitude(a.normals);
  found.a_n = amplitude(a.normal_forces);
  found.a_t = amplitude(a.tangential_forces);
  found.a_l = amplitude(a.branches);
  found.a_lt = amplitude(a.tangential_branches);
  found.predicted = predicted_stress_ratio(found, dimension);
  found.measured = deviatoric_stress(stress, dimension) / p;
  return found;
}

}  // namespace rvelab
