// Elastic tangent by static condensation of all degrees of freedom of the grains, and the affine sum. Derived in
// tangent.hpp and in solver/README.md.
//
// Unknowns of a grain: displacement (m) and rotation times the mean radius (m), so that every stiffness is in N/m. For
// a contact, q = (db, dtheta_i, dtheta_j) = P x + (H b, 0, 0), and its forces load the grains by the transpose:
//   K x = g,  K = -sum P^T A P,  g = sum P^T A (H b, 0, 0),  d sigma = -(1/V) sum (dF (x) b + F (x) db) - sigma tr H.
#include "rvelab/measure/tangent.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/measure/block_factors.hpp"
#include "rvelab/measure/contact_linear.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/solid_linear.hpp"
#include "rvelab/measure/tensor_order.hpp"

namespace rvelab {
namespace {

using Vector = Eigen::VectorXd;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// A contact with the rows dF, dT_i, dT_j of its law, and the law's share of unloading (rows times dl).
struct LinearSpring {
  const ContactState* contact;
  Matrix9 law;                        ///< with half of the unloading terms
  Vector9 unloading;                  ///< half of the unloading terms; the other half is +- |dl|
  Vector9 opening = Vector9::Zero();  ///< not round: dl per q, where round grains have n.db
};

Matrix9 rows_of(const LinearContact& linear) {
  Matrix9 rows;
  rows << linear.force, linear.torque_i, linear.torque_j;
  return rows;
}

Matrix3 crossed(const Vector3& a) {
  Matrix3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// A contact of members of two bodies, offsets o from the bodies' centres: the members' branch moves by
/// db + dtheta_j x o_j - dtheta_i x o_i, their force turns the bodies by +- o x F, and the offset turns under the
/// force.
LinearSpring spring_of_bodies(const Network& network, const ContactState& contact) {
  ContactState of_members = contact;
  of_members.branch = contact.member_branch;
  const double ri = network.members[std::size_t(contact.member_i)].radius,
               rj = network.members[std::size_t(contact.member_j)].radius;
  Matrix9 to_members = Matrix9::Identity();
  to_members.block<3, 3>(0, 3) = crossed(contact.offset_i);
  to_members.block<3, 3>(0, 6) = -crossed(contact.offset_j);
  Matrix9 to_bodies = Matrix9::Identity();
  to_bodies.block<3, 3>(3, 0) = -crossed(contact.offset_i);
  to_bodies.block<3, 3>(6, 0) = crossed(contact.offset_j);
  LinearSpring spring{&contact, Matrix9::Zero(), Vector9::Zero()};
  Matrix9 law = rows_of(linearised(of_members, ri, rj, network.model.slip));
  spring.opening = to_members.topRows<3>().transpose() * contact.normal;
  if (rescales(network)) {
    const Matrix9 half = 0.5 * rows_of(unloading_terms(of_members, ri, rj));
    law += half;
    spring.unloading = to_bodies * (half.leftCols<3>() * contact.normal);
  }
  spring.law = to_bodies * law * to_members;
  // do x F = -F x (dtheta x o), with - on i: a force on j.
  const Matrix3 force = crossed(contact.force());
  spring.law.block<3, 3>(3, 3) -= force * crossed(contact.offset_i);
  spring.law.block<3, 3>(6, 6) += force * crossed(contact.offset_j);
  return spring;
}

/// Half of the unloading terms stands in the linear law, so that with r = half the terms per dl the law is
/// law q + r |dl|: exact for loading (dl < 0: nothing) and for unloading (dl > 0: all).
LinearSpring spring_of(const Network& network, const ContactState& contact) {
  const GrainState &i = network.grains[contact.i], &j = network.grains[contact.j];
  const bool unloads = rescales(network);
  if (network.has_bodies() && !network.has_solids()) return spring_of_bodies(network, contact);
  if (is_round(network.shape)) {
    LinearSpring spring{&contact, rows_of(linearised(contact, i.radius, j.radius, network.model.slip)),
                        Vector9::Zero()};
    if (!unloads) return spring;
    const Matrix9 half = 0.5 * rows_of(unloading_terms(contact, i.radius, j.radius));
    spring.law += half;
    spring.unloading = half.leftCols<3>() * contact.normal;
    return spring;
  }
  const LinearOutlineContact linear =
      network.has_solids() ? linearised_solids(contact, i, network.axes[std::size_t(contact.i)], j,
                                               network.axes[std::size_t(contact.j)], hertz_radius(network))
                           : linearised_outlines(network.shape, contact, i, j, hertz_radius(network));
  LinearSpring spring{&contact, rows_of(linear.law), Vector9::Zero(), linear.opening.transpose()};
  if (!unloads) return spring;
  const Matrix9 half = 0.5 * rows_of(linear.unloading);
  spring.law += half;
  spring.unloading = half * spring.opening / spring.opening.squaredNorm();
  return spring;
}

LinearSpring spring_of(const Network& network, const InteractionState& other) {
  const LinearContact linear =
      linearised(other, network.grains[std::size_t(other.i)].radius, network.grains[std::size_t(other.j)].radius);
  return {&other, rows_of(linear), Vector9::Zero()};
}

/// A strain in the frame of the cell: I + H = (I + turn)(I + stretch) to first order, stretch upper triangular. The
/// frame rotates by `turn`; in it the grains rotate on average with the spin of the stretch. Contact forces are stored
/// in this frame, which matters only for the slip convention that is not objective (full_radius).
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

/// The network without rattlers, its stiffness factorised. F: degrees of freedom of a grain, displacements first.
template <int F>
class Condensed {
 public:
  explicit Condensed(const Network& network) : network_(network) {
    number_grains();
    for (const ContactState& contact : network.contacts) {
      if (number_[contact.i] >= 0 && number_[contact.j] >= 0) springs_.push_back(spring_of(network, contact));
    }
    for (const InteractionState& other : network.interactions)
      if (number_[std::size_t(other.i)] >= 0 && number_[std::size_t(other.j)] >= 0)
        springs_.push_back(spring_of(network, other));
    factorise();
  }

  Matrix3 stress_change(const CellStrain& strain) const {
    StressChange change;
    if (springs_.empty()) return change.value(network_, strain);
    const Vector x = balance(strain);
    for (const LinearSpring& spring : springs_) {
      const Vector9 q = motion(spring, strain, x);
      const Vector9 response = spring.law * q + spring.unloading * std::abs(elongation(spring, q));
      change.add(*spring.contact, response.head<3>(), q.head<3>());
    }
    return change.value(network_, strain);
  }

 private:
  using Block = Eigen::Matrix<double, F, F>;
  static constexpr bool plane = F == 3;

  void number_grains() {
    const std::vector<bool> removed = rattlers(network_);
    number_.assign(removed.size(), -1);
    for (std::size_t g = 0; g < removed.size(); ++g) {
      if (removed[g]) continue;
      number_[g] = count_++;
      length_ += network_.grains[g].radius;
    }
    if (count_ > 0) length_ /= count_;
  }

  /// P of one contact: motions q, 9 rows, of the degrees of freedom of i, then those of j.
  Eigen::Matrix<double, 9, 2 * F> compatibility() const {
    Eigen::Matrix<double, 9, 2 * F> p = Eigen::Matrix<double, 9, 2 * F>::Zero();
    constexpr int displacements = plane ? 2 : 3;
    for (int k = 0; k < displacements; ++k) {
      p(k, k) = -1;
      p(k, F + k) = 1;
    }
    for (int k = displacements; k < F; ++k) {
      const int axis = plane ? 2 : k - displacements;
      p(3 + axis, k) = p(6 + axis, F + k) = 1 / length_;
    }
    return p;
  }

  int number_i(const LinearSpring& spring) const { return number_[spring.contact->i]; }
  int number_j(const LinearSpring& spring) const { return number_[spring.contact->j]; }

  void factorise() {
    if (springs_.empty()) return;
    p_ = compatibility();
    std::vector<std::array<int, 2>> pairs;
    pairs.reserve(springs_.size());
    for (const LinearSpring& spring : springs_) pairs.push_back({number_i(spring), number_j(spring)});
    factors_ = BlockFactors<F>(std::size_t(count_), pairs);
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      const Eigen::Matrix<double, 2 * F, 2 * F> local = -p_.transpose() * springs_[s].law * p_;
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b)
          factors_.at(pairs[s][std::size_t(a)], pairs[s][std::size_t(b)]) += local.template block<F, F>(F * a, F * b);
    }
    // A small spring to the ground on every degree of freedom holds translations and free spins; refinement removes
    // its effect.
    factors_.add_to_diagonal(1e-10 * factors_.largest_on_diagonal());
    if (!factors_.factorise()) {
      throw Error("elastic tangent: the stiffness of the contact network cannot be factorised (" +
                  std::to_string(springs_.size()) + " contacts, every stiffness must be finite); relax the specimen");
    }
  }

  Vector9 motion(const LinearSpring& spring, const CellStrain& strain, const Vector& x) const {
    return strain.mean_motion(*spring.contact) + p_.template leftCols<F>() * x.segment<F>(F * number_i(spring)) +
           p_.template rightCols<F>() * x.segment<F>(F * number_j(spring));
  }

  double elongation(const LinearSpring& spring, const Vector9& q) const {
    return is_round(network_.shape) && !network_.has_bodies() ? spring.contact->normal.dot(q.head<3>())
                                                              : spring.opening.dot(q);
  }

  /// Unbalanced load on the degrees of freedom at the motion x, into `load`; its largest component.
  double residual(const CellStrain& strain, const Vector& x, Vector& load) const {
    load.setZero();
    for (const LinearSpring& spring : springs_) {
      const Vector9 q = motion(spring, strain, x);
      const Eigen::Matrix<double, 2 * F, 1> local =
          p_.transpose() * (spring.law * q + spring.unloading * std::abs(elongation(spring, q)));
      load.segment<F>(F * number_i(spring)) += local.template head<F>();
      load.segment<F>(F * number_j(spring)) += local.template tail<F>();
    }
    return load.cwiseAbs().maxCoeff();
  }

  /// The motion that brings every grain into equilibrium. The |dl| terms are small compared with the springs, so that
  /// iteration with the linear part converges; without them this is iterative refinement. Stops when the residual no
  /// longer falls: at round-off, or at the imbalance of the state itself on a free spin.
  Vector balance(const CellStrain& strain) const {
    constexpr int most_iterations = 200;
    constexpr double exact = 1e-13;
    const double sufficient = std::max(1e-6, unbalanced_force_ratio(network_));
    Vector x = Vector::Zero(F * count_), best = x, load = x, scratch = x;
    const double scale = load_scale(strain);
    double smallest = residual(strain, x, load) / scale;
    int idle = 0;
    for (int iteration = 0; iteration < most_iterations && idle < 2 && smallest > exact; ++iteration) {
      factors_.solve(load, scratch);
      x += load;
      const double found = residual(strain, x, load) / scale;
      idle = found < 0.7 * smallest ? 0 : idle + 1;
      if (found < smallest) {
        smallest = found;
        best = x;
      }
    }
    if (smallest <= sufficient) return best;
    throw Error("elastic tangent: grains are balanced to " + in_words(smallest) + " of the load only, allowed: " +
                in_words(sufficient) + "; relax the specimen, or use the dynamic method");
  }

  /// Largest force that a contact feels when all grains move with the strain, N.
  double load_scale(const CellStrain& strain) const {
    double largest = 0;
    for (const LinearSpring& spring : springs_) {
      const Vector9 q = strain.mean_motion(*spring.contact);
      largest = std::max(largest, (spring.law.topRows<3>() * q).cwiseAbs().maxCoeff());
    }
    return largest > 0 ? largest : 1.0;
  }

  const Network& network_;
  int count_ = 0;  ///< grains
  double length_ = 0;
  std::vector<int> number_;  ///< of each grain among them, -1 of rattlers
  std::vector<LinearSpring> springs_;
  Eigen::Matrix<double, 9, 2 * F> p_;
  BlockFactors<F> factors_;
};

template <int F>
Eigen::MatrixXd condensed_tangent(const Network& network) {
  const int dimension = network.dimension(), size = component_count(dimension);
  Eigen::MatrixXd tangent(size, size);
  const Condensed<F> condensed(network);
  for (int k = 0; k < size; ++k) {
    Matrix3 change = condensed.stress_change(CellStrain(network, k, 1));
    if (rescales(network)) change = 0.5 * (change - condensed.stress_change(CellStrain(network, k, -1)));
    tangent.col(k) = stress_components(change, dimension);
  }
  return tangent;
}

}  // namespace

Eigen::MatrixXd elastic_tangent(const Network& network) {
  return network.dimension() == 2 ? condensed_tangent<3>(network) : condensed_tangent<6>(network);
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
    for (const InteractionState& other : network.interactions) {
      const Vector9 q = strain.mean_motion(other);
      change.add(other, spring_of(network, other).law.topRows<3>() * q, q.head<3>());
    }
    tangent.col(k) = stress_components(change.value(network, strain), dimension);
  }
  return tangent;
}

}  // namespace rvelab
