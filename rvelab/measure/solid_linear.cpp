#include "rvelab/measure/solid_linear.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "rvelab/specimen/solids.hpp"

namespace rvelab {
namespace {

/// The matrix of v -> a x v.
Matrix3 cross_of(const Vector3& a) {
  Matrix3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

SupportAt<double> support_of(const GrainState& grain, const Matrix3& axes, const Vector3& n) {
  const auto column = [&](int k) { return Triple<double>{axes(0, k), axes(1, k), axes(2, k)}; };
  return support_at(plain_form_of(superellipsoid_of(grain)),
                    SuperellipsoidAxes<double>{column(0), column(1), column(2)}, Triple<double>{n.x(), n.y(), n.z()});
}
/// Radii of curvature across n (m), n the outward normal of a grain, limited to a million times its size: larger radii
/// of flat sides make no difference at a contact.
Matrix3 curvature_radii(const GrainState& grain, const Matrix3& axes, const Vector3& n) {
  const SupportAt<double> at = support_of(grain, axes, n);
  const double most = 1e6 * grain.radius;
  Matrix3 radii = Matrix3::Zero();
  for (const SupportMode<double>& mode : {at.xy, at.z}) {
    const Vector3 along(mode.along.x, mode.along.y, mode.along.z);
    const double squared = along.squaredNorm();
    if (squared > 0) radii += std::min(mode.stiffness * squared, most) / squared * along * along.transpose();
  }
  return radii;
}

/// d ln R* (contact/hertz_curvature.hpp) by finite differences, as n and both bodies rotate.
ContactRow relative_radius(const GrainState& grain_i, const Matrix3& axes_i, const ContactMatrix& turn_i,
                           const GrainState& grain_j, const Matrix3& axes_j, const ContactMatrix& turn_j,
                           const Vector3& n, const ContactMatrix& dn) {
  const auto most = [](const GrainState& grain) {
    const Superellipsoid s = superellipsoid_of(grain);
    return largest_radius(Triple<double>{s.a, s.b, s.c});
  };
  const auto radius = [&](int column, double step) {
    const auto turned = [&](const Matrix3& axes, const Vector3& by) {
      return Matrix3(Eigen::AngleAxisd(step * by.norm(), by.stableNormalized()) * axes);
    };
    const Vector3 there = (n + step * dn.col(column)).normalized();
    return hertz_radius(support_of(grain_i, turned(axes_i, turn_i.col(column)), there),
                        support_of(grain_j, turned(axes_j, turn_j.col(column)), -there), most(grain_i), most(grain_j));
  };
  ContactRow change;
  for (int column = 0; column < change.size(); ++column) {
    // dn is by m of the branch, or by rad.
    const double step = 1e-5 / std::max({dn.col(column).norm(), turn_i.col(column).norm(), turn_j.col(column).norm(),
                                         1e-3 / grain_i.radius});
    change[column] = (radius(column, step) - radius(column, -step)) / (2 * step * radius(column, 0));
  }
  return change;
}

}  // namespace

LinearOutlineContact linearised_solids(const ContactState& contact, const GrainState& grain_i, const Matrix3& axes_i,
                                       const GrainState& grain_j, const Matrix3& axes_j, HertzRadius hertz_radius) {
  const Vector3 &n = contact.normal, &ft = contact.tangential_force, &moment = contact.rolling_moment;
  const Vector3 &xi = contact.arm_i, &xj = contact.arm_j, half = 0.5 * contact.overlap * n, pi = xi + half,
                pj = xj - half;
  const Matrix3 across = Matrix3::Identity() - n * n.transpose();
  ContactMatrix db = ContactMatrix::Zero(), turn_i = ContactMatrix::Zero(), turn_j = ContactMatrix::Zero();
  db.block<3, 3>(0, 0).setIdentity();
  turn_i.block<3, 3>(0, 3).setIdentity();
  turn_j.block<3, 3>(0, 6).setIdentity();
  // theta x a = -a x theta
  const auto turned_by = [](const ContactMatrix& theta, const Vector3& a) -> ContactMatrix {
    return -cross_of(a) * theta;
  };

  const ContactMatrix moved = db + turned_by(turn_j, xj) - turned_by(turn_i, xi);
  const ContactRow overlap = -n.transpose() * moved;
  const Matrix3 ci = curvature_radii(grain_i, axes_i, n), cj = curvature_radii(grain_j, axes_j, -n);
  const Matrix3 stiff = ci + cj - contact.overlap * across + grain_i.radius * n * n.transpose();
  const ContactMatrix push = across * (db + turned_by(turn_j, pj) - turned_by(turn_i, pi)) + ci * turned_by(turn_i, n) +
                             cj * turned_by(turn_j, n);
  const ContactMatrix dn = across * stiff.ldlt().solve(push);

  const ContactRow twist = 0.5 * n.transpose() * (turn_i + turn_j);
  const auto turned = [&](const Vector3& v) -> ContactMatrix { return -n * (v.transpose() * dn) + n.cross(v) * twist; };
  const ContactMatrix dft = turned(ft) - contact.tangential_stiffness * across * moved;
  const ContactMatrix dm = turned(moment) - contact.rolling_stiffness * across * (turn_j - turn_i);

  // (delta/R*) dR*: what the change of the radius is to the root of delta R*.
  ContactRow radius = ContactRow::Zero();
  if (hertz_radius == HertzRadius::curvature)
    radius = contact.overlap * relative_radius(grain_i, axes_i, turn_i, grain_j, axes_j, turn_j, n, dn);
  LinearOutlineContact linear;
  linear.opening = -(overlap + radius);
  const ContactRow normal = contact.normal_stiffness * overlap + 0.5 * contact.normal_force / contact.overlap * radius;
  linear.law.force = n * normal + contact.normal_force * dn + dft;
  const ContactMatrix dpi = turned_by(turn_i, pi) + ci * (dn - turned_by(turn_i, n));
  const ContactMatrix dpj = turned_by(turn_j, pj) - cj * (dn - turned_by(turn_j, n));
  const ContactMatrix dxi = 0.5 * (dpi + dpj + db), dxj = dxi - db;
  const Matrix3 force = cross_of(contact.force());
  linear.law.torque_i = force * dxi - cross_of(xi) * linear.law.force - dm;
  linear.law.torque_j = -force * dxj + cross_of(xj) * linear.law.force + dm;

  const ContactRow relative = contact.stiffness_growth * (overlap + radius);
  const ContactMatrix rolling = moment * relative;
  linear.unloading.force = ft * relative;
  linear.unloading.torque_i = -cross_of(xi) * linear.unloading.force - rolling;
  linear.unloading.torque_j = cross_of(xj) * linear.unloading.force + rolling;
  return linear;
}

}  // namespace rvelab
