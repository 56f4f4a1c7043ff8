#include "rvelab/measure/anisotropy.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
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

/// Least squares of a field over the directions: the tensor A with the least squared difference of field(A, n) and
/// value(contact), both vectors, summed over the contacts. `tensors`: the basis of A. Parts of A that the normals do
/// not determine (those of a square lattice) are zero.
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

/// n_i n_j, each pair once; products of two such vectors are squares of the product of their directions.
using Squares = Eigen::Matrix<double, 6, 1>;
using Moments = Eigen::Matrix<double, 6, 6>;
Squares squares(const Vector3& n) {
  Squares all;
  all << n.cwiseProduct(n), std::sqrt(2) * n[1] * n[2], std::sqrt(2) * n[0] * n[2], std::sqrt(2) * n[0] * n[1];
  return all;
}

/// <n n n n> of the normals, cell frame.
Moments fourth_moments(const Network& network) {
  Moments sum = Moments::Zero();
  for (const ContactState& contact : network.contacts) {
    const Squares all = squares(contact.normal);
    sum += all * all.transpose();
  }
  return sum / static_cast<double>(network.contacts.size());
}

/// Amplitude of the fourth order: E:E of <n n n n> minus the parts of lower order (Kanatani 1984).
double fourth_order_amplitude(const Network& network) {
  const double second = fabric(network).squaredNorm(), whole = fourth_moments(network).squaredNorm();
  const bool plane = network.dimension() == 2;
  const double traceless = plane ? whole - second + 1.0 / 8 : whole - 6.0 / 7 * second + 3.0 / 35;
  return (plane ? std::sqrt(32.0) : 315.0 / 8 * std::sqrt(8.0 / 35)) * std::sqrt(std::max(traceless, 0.0));
}

struct QuadraturePoint {
  Vector3 n;
  double weight;
};
/// Half of all directions, for functions that are even and of degree 10 at most: their mean is the weighted sum.
std::vector<QuadraturePoint> quadrature(int dimension) {
  constexpr int around = 12;
  std::vector<QuadraturePoint> all;
  if (dimension == 2) {
    for (int k = 0; k < around; ++k) {
      const double angle = std::numbers::pi * k / around;
      all.push_back({{std::cos(angle), std::sin(angle), 0}, 1.0 / around});
    }
    return all;
  }
  constexpr double z[] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521},  // Gauss and Legendre
      weights[] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  for (int i = 0; i < 3; ++i) {
    const double across = std::sqrt(1 - z[i] * z[i]);
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      all.push_back({{across * std::cos(angle), across * std::sin(angle), z[i]}, weights[i] / around});
    }
  }
  return all;
}

/// n (1 + n.a n) and, across n, a_t n - (n.a_t n) n.
Vector3 distributed(const Vector3& n, const Matrix3& along, const Matrix3& across) {
  return n + along_normal(along, n) + across_normal(across, n);
}

/// Stress of the distributions over f_0 l_0 N/V, compression positive, laboratory frame.
Matrix3 stress_of(const Network& network, const Anisotropies& a) {
  const int dimension = network.dimension();
  const Matrix3 phi = fabric(network);
  const Moments fourth = fourth_moments(network);
  Matrix3 sum = Matrix3::Zero();
  for (const auto& [n, weight] : quadrature(dimension)) {
    const Squares all = squares(network.cell.rotation.transpose() * n);
    const double m2 = n.dot(phi * n), m4 = all.dot(fourth * all);
    const double density = dimension == 2 ? 1 + 2 * (2 * m2 - 1) + 2 * (8 * m4 - 8 * m2 + 1)
                                          : 1 + 2.5 * (3 * m2 - 1) + 9.0 / 8 * (35 * m4 - 30 * m2 + 3);
    sum += weight * density * distributed(n, a.normal_forces, a.tangential_forces) *
           distributed(n, a.branches, a.tangential_branches).transpose();
  }
  return 0.5 * (sum + sum.transpose());
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
  const Matrix3 predicted = stress_of(network, a);
  found.predicted = std::sqrt(dimension == 2 ? 0.5 : 1.5) * deviator(predicted, dimension).cwiseProduct(s).sum() /
                    size / (predicted.trace() / dimension);
  found.measured = deviatoric_stress(stress, dimension) / p;
  return found;
}

}  // namespace rvelab
