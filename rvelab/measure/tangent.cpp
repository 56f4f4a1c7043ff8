// Elastic tangent by static condensation of all grain freedoms, and the affine sum. Derived in tangent.hpp and in
// solver/README.md.
//
// Unknowns of a grain: displacement (m) and rotation times the mean radius (m), so that every stiffness is in N/m. For
// a contact, q = (db, dtheta_i, dtheta_j) = P x + (H b, 0, 0), and its forces load the grains by the transpose:
//   K x = g,  K = -sum P^T A P,  g = sum P^T A (H b, 0, 0),  d sigma = -(1/V) sum (dF (x) b + F (x) db) - sigma tr H.
#include "rvelab/measure/tangent.hpp"

#include <Eigen/Sparse>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/measure/contact_linear.hpp"
#include "rvelab/measure/ellipse_linear.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/tensor_order.hpp"

namespace rvelab {
namespace {

using Vector = Eigen::VectorXd;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// A contact with the rows dF, dT_i, dT_j of its law, and the law's share of unloading (rows times dl).
struct Spring {
  const ContactState* contact;
  Matrix9 law;                        ///< with half of the unloading terms
  Vector9 unloading;                  ///< half of the unloading terms; the other half is +- |dl|
  Vector9 opening = Vector9::Zero();  ///< ellipses: dl per q, where round grains have n.db
};

Matrix9 rows_of(const LinearContact& linear) {
  Matrix9 rows;
  rows << linear.force, linear.torque_i, linear.torque_j;
  return rows;
}

/// Half of the unloading terms stands in the linear law, so that with r = half the terms per dl the law is
/// law q + r |dl|: exact for loading (dl < 0: nothing) and for unloading (dl > 0: all).
Spring spring_of_ellipses(const Network& network, const ContactState& contact) {
  const LinearEllipseContact linear =
      linearised_ellipses(contact, network.grains[contact.i], network.grains[contact.j], network.model.hertz_radius);
  Spring spring{&contact, rows_of(linear.law), Vector9::Zero(), linear.opening.transpose()};
  if (rescales(network)) {
    const Matrix9 half = 0.5 * rows_of(linear.unloading);
    spring.law += half;
    spring.unloading = half * spring.opening / spring.opening.squaredNorm();
  }
  return spring;
}

Spring spring_of(const Network& network, const ContactState& contact) {
  if (network.shape == Shape::ellipse) return spring_of_ellipses(network, contact);
  const double ri = network.grains[contact.i].radius, rj = network.grains[contact.j].radius;
  Spring spring{&contact, rows_of(linearised(contact, ri, rj, network.model.slip)), Vector9::Zero()};
  if (rescales(network)) {
    const Matrix9 half = 0.5 * rows_of(unloading_terms(contact, ri, rj));
    spring.law += half;
    spring.unloading = half.leftCols<3>() * contact.normal;
  }
  return spring;
}

/// A strain as the cell sees it: I + H = (I + turn)(I + stretch) to first order, stretch upper triangular. The frame
/// turns by `turn`; in it the grains turn on average with the spin of the stretch. Contact histories are carried in
/// this frame, which shows in the one slip convention that is not objective (full_radius).
struct CellStrain {
  Matrix3 stretch, turn;
  Vector9 rotations;  ///< mean motion q of two grains without their branch: (0, spin, spin)

  CellStrain(const Network& network, int direction, double sign) {
    const Matrix3& q = network.cell.rotation;
    const Matrix3 strain = sign * q.transpose() * unit_strain(direction, network.dimension()) * q;
    const Matrix3 lower = strain.triangularView<Eigen::StrictlyLower>();
    turn = lower - lower.transpose();
    stretch = strain - turn;
    const Vector3 spin = 0.5 * Vector3(-stretch(1, 2), stretch(0, 2), -stretch(0, 1));
    rotations << Vector3::Zero(), spin, spin;
  }

  /// q of a contact whose grains move with the mean.
  Vector9 mean_motion(const ContactState& contact) const {
    Vector9 q = rotations;
    q.head<3>() = stretch * contact.branch;
    return q;
  }
};

/// d sigma, summed over contacts.
class StressChange {
 public:
  void add(const ContactState& contact, const Vector3& force_change, const Vector3& branch_change) {
    change_ -= force_change * contact.branch.transpose() + contact.force() * branch_change.transpose();
    stress_ -= contact.force() * contact.branch.transpose();
  }
  /// In the laboratory frame.
  Matrix3 value(const Network& network, const CellStrain& strain) const {
    const Matrix3& rotation = network.cell.rotation;
    const Matrix3 turned = strain.turn * stress_ - stress_ * strain.turn;
    const Matrix3 change = (change_ + turned - strain.stretch.trace() * stress_) / network.cell.volume();
    return rotation * change * rotation.transpose();
  }

 private:
  Matrix3 change_ = Matrix3::Zero(), stress_ = Matrix3::Zero();
};

/// The network without rattlers, its stiffness factorised.
class Condensed {
 public:
  explicit Condensed(const Network& network) : network_(network) {
    number_freedoms();
    for (const ContactState& contact : network.contacts) {
      if (first_[contact.i] >= 0 && first_[contact.j] >= 0) springs_.push_back(spring_of(network, contact));
    }
    factorise();
  }

  Matrix3 stress_change(const CellStrain& strain) {
    StressChange change;
    if (springs_.empty()) return change.value(network_, strain);
    const Vector x = balance(strain);
    for (const Spring& spring : springs_) {
      const Vector9 q = motion(spring, strain, x);
      const Vector9 response = spring.law * q + spring.unloading * std::abs(elongation(spring, q));
      change.add(*spring.contact, response.head<3>(), q.head<3>());
    }
    return change.value(network_, strain);
  }

 private:
  void number_freedoms() {
    const std::vector<bool> removed = rattlers(network_);
    freedoms_ = network_.dimension() == 2 ? 3 : 6;
    first_.assign(removed.size(), -1);
    for (std::size_t g = 0; g < removed.size(); ++g) {
      if (removed[g]) continue;
      first_[g] = count_;
      count_ += freedoms_;
      length_ += network_.grains[g].radius;
    }
    if (count_ > 0) length_ /= count_ / freedoms_;
  }

  /// Columns of P for one grain: direction of the k-th freedom in space, and whether it is a rotation.
  int axis(int k) const { return network_.dimension() == 2 ? (k < 2 ? k : 2) : k % 3; }
  bool is_rotation(int k) const { return k >= freedoms_ - (network_.dimension() == 2 ? 1 : 3); }

  /// P of one contact, 9 rows, the freedoms of i, then those of j.
  Eigen::Matrix<double, 9, Eigen::Dynamic> compatibility() const {
    Eigen::Matrix<double, 9, Eigen::Dynamic> p(9, 2 * freedoms_);
    p.setZero();
    for (int k = 0; k < freedoms_; ++k) {
      if (is_rotation(k)) {
        p(3 + axis(k), k) = p(6 + axis(k), freedoms_ + k) = 1 / length_;
      } else {
        p(axis(k), k) = -1;
        p(axis(k), freedoms_ + k) = 1;
      }
    }
    return p;
  }

  int freedom(const ContactState& contact, int k) const {
    return k < freedoms_ ? first_[contact.i] + k : first_[contact.j] + k - freedoms_;
  }

  void factorise() {
    if (springs_.empty()) return;
    p_ = compatibility();
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(springs_.size() * 4 * freedoms_ * freedoms_);
    for (const Spring& spring : springs_) {
      const Eigen::MatrixXd local = -p_.transpose() * spring.law * p_;
      for (int a = 0; a < 2 * freedoms_; ++a) {
        for (int b = 0; b < 2 * freedoms_; ++b) {
          entries.emplace_back(freedom(*spring.contact, a), freedom(*spring.contact, b), local(a, b));
        }
      }
    }
    stiffness_.resize(count_, count_);
    stiffness_.setFromTriplets(entries.begin(), entries.end());
    // A small spring to the ground on every freedom holds translations and free spins; refinement takes it out again.
    const double ground = 1e-10 * stiffness_.diagonal().cwiseAbs().maxCoeff();
    Eigen::SparseMatrix<double> held = stiffness_;
    for (int k = 0; k < count_; ++k) held.coeffRef(k, k) += ground;
    held.makeCompressed();
    solver_.compute(held);
    if (solver_.info() != Eigen::Success) {
      throw Error("elastic tangent: the stiffness of the contact network cannot be factorised (" +
                  std::to_string(springs_.size()) + " contacts, every stiffness must be finite); relax the specimen");
    }
  }

  Vector9 motion(const Spring& spring, const CellStrain& strain, const Vector& x) const {
    Vector local(2 * freedoms_);
    for (int k = 0; k < 2 * freedoms_; ++k) local[k] = x[freedom(*spring.contact, k)];
    return strain.mean_motion(*spring.contact) + p_ * local;
  }

  double elongation(const Spring& spring, const Vector9& q) const {
    return network_.shape == Shape::ellipse ? spring.opening.dot(q) : spring.contact->normal.dot(q.head<3>());
  }

  /// Unbalanced load on the freedoms at the motion x.
  Vector residual(const CellStrain& strain, const Vector& x) const {
    Vector load = Vector::Zero(count_);
    for (const Spring& spring : springs_) {
      const Vector9 q = motion(spring, strain, x);
      const Vector local = p_.transpose() * (spring.law * q + spring.unloading * std::abs(elongation(spring, q)));
      for (int k = 0; k < 2 * freedoms_; ++k) load[freedom(*spring.contact, k)] += local[k];
    }
    return load;
  }

  /// The motion at which every grain is balanced. The |dl| terms are small beside the springs, so that iterating with
  /// the linear part converges; without them this is iterative refinement. Stops where the residual falls no further:
  /// at round-off, or where a free spin bears what the state itself lacks in balance.
  Vector balance(const CellStrain& strain) {
    constexpr int most_iterations = 200;
    constexpr double exact = 1e-13;
    const double sufficient = std::max(1e-6, unbalanced_force_ratio(network_));
    Vector x = Vector::Zero(count_), best = x;
    const double load = load_scale(strain);
    double smallest = residual(strain, x).cwiseAbs().maxCoeff() / load;
    int idle = 0;
    for (int iteration = 0; iteration < most_iterations && idle < 2 && smallest > exact; ++iteration) {
      x += solver_.solve(residual(strain, x));
      const double found = residual(strain, x).cwiseAbs().maxCoeff() / load;
      idle = found < 0.7 * smallest ? 0 : idle + 1;
      if (found < smallest) {
        smallest = found;
        best = x;
      }
    }
    if (smallest <= sufficient) return best;
    std::ostringstream message;
    message << "elastic tangent: grains are balanced to " << smallest << " of the load only, allowed: " << sufficient
            << "; relax the specimen, or use the dynamic method";
    throw Error(message.str());
  }

  /// Largest force that a contact feels when all grains move with the strain, N.
  double load_scale(const CellStrain& strain) const {
    double largest = 0;
    for (const Spring& spring : springs_) {
      const Vector9 q = strain.mean_motion(*spring.contact);
      largest = std::max(largest, (spring.law.topRows<3>() * q).cwiseAbs().maxCoeff());
    }
    return largest > 0 ? largest : 1.0;
  }

  const Network& network_;
  int freedoms_ = 0, count_ = 0;
  double length_ = 0;
  std::vector<int> first_;
  std::vector<Spring> springs_;
  Eigen::Matrix<double, 9, Eigen::Dynamic> p_;
  Eigen::SparseMatrix<double> stiffness_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace

Eigen::MatrixXd elastic_tangent(const Network& network) {
  const int dimension = network.dimension(), size = component_count(dimension);
  Eigen::MatrixXd tangent(size, size);
  Condensed condensed(network);
  for (int k = 0; k < size; ++k) {
    Matrix3 change = condensed.stress_change(CellStrain(network, k, 1));
    if (rescales(network)) change = 0.5 * (change - condensed.stress_change(CellStrain(network, k, -1)));
    tangent.col(k) = stress_components(change, dimension);
  }
  return tangent;
}

Eigen::MatrixXd affine_tangent(const Network& network) {
  const int dimension = network.dimension(), size = component_count(dimension);
  Eigen::MatrixXd tangent(size, size);
  for (int k = 0; k < size; ++k) {
    const CellStrain strain(network, k, 1);
    StressChange change;
    for (const ContactState& contact : network.contacts) {
      const Vector9 q = strain.mean_motion(contact);
      change.add(contact, spring_of(network, contact).law.topRows<3>() * q, q.head<3>());
    }
    tangent.col(k) = stress_components(change.value(network, strain), dimension);
  }
  return tangent;
}

}  // namespace rvelab
