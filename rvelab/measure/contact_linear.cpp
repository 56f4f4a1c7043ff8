// One contact, linearised (formulas at the head of contact_linear.hpp).
#include "rvelab/measure/contact_linear.hpp"

#include "rvelab/contact/laws.hpp"

namespace rvelab {
namespace {

/// The matrix of v -> a x v.
Matrix3 cross_with(const Vector3& a) {
  Matrix3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// Torques from the change of f_t (dft), of M (dm), of the normal and of the arms.
void add_torques(LinearContact& linear, const ContactState& contact, double ri, double rj, const ContactMatrix& dft,
                 const ContactMatrix& dm, const ContactMatrix& dn, const ContactRow& dl) {
  const Matrix3 normal_cross = cross_with(contact.normal), force_cross = cross_with(contact.tangential_force);
  const double arm_i = ri - 0.5 * contact.overlap, arm_j = rj - 0.5 * contact.overlap;
  // d(-a n x f_t) = -da n x f_t - a dn x f_t - a n x df_t with da = dl/2
  const Vector3 turning = contact.normal.cross(contact.tangential_force);
  const ContactMatrix by_arm = -0.5 * turning * dl;
  const ContactMatrix per_arm = force_cross * dn - normal_cross * dft;
  linear.torque_i = by_arm + arm_i * per_arm - dm;
  linear.torque_j = by_arm + arm_j * per_arm + dm;
}

}  // namespace

LinearContact linearised(const ContactState& contact, double ri, double rj, Slip slip) {
  const Vector3& n = contact.normal;
  const Vector3& ft = contact.tangential_force;
  const Vector3& moment = contact.rolling_moment;
  const Matrix3 tangent_plane = Matrix3::Identity() - n * n.transpose();
  const Matrix3 normal_cross = cross_with(n);

  ContactMatrix db = ContactMatrix::Zero(), turn_i = ContactMatrix::Zero(), turn_j = ContactMatrix::Zero();
  db.block<3, 3>(0, 0).setIdentity();
  turn_i.block<3, 3>(0, 3).setIdentity();
  turn_j.block<3, 3>(0, 6).setIdentity();
  const ContactMatrix dn = tangent_plane * db / contact.length;
  const ContactRow dl = n.transpose() * db;

  const double half = 0.5 * contact.overlap;
  const bool from_arms = slip == Slip::consistent;
  const double ci = from_arms ? ri - half : ri, cj = from_arms ? rj - half : rj;
  const double stretch = slip == Slip::full_radius_ratcheting ? (ri + rj) / contact.length : 1.0;
  // theta x n = -n x theta
  const ContactMatrix slipped = tangent_plane * (stretch * db + normal_cross * (cj * turn_j + ci * turn_i));
  ContactRow twist = ContactRow::Zero();
  if (slip != Slip::full_radius) twist = 0.5 * n.transpose() * (turn_i + turn_j);

  const auto turned = [&](const Vector3& v) -> ContactMatrix { return -n * (v.transpose() * dn) + n.cross(v) * twist; };
  const ContactMatrix dft = turned(ft) - contact.tangential_stiffness * slipped;
  const ContactMatrix dm = turned(moment) - contact.rolling_stiffness * tangent_plane * (turn_j - turn_i);

  LinearContact linear;
  linear.force = -contact.normal_stiffness * n * dl + contact.normal_force * dn + dft;
  add_torques(linear, contact, ri, rj, dft, dm, dn, dl);
  return linear;
}

bool rescales(const Network& network) {
  const bool carried = with_law(network.model.law, [](auto law) { return decltype(law)::Force::stores_root_overlap; });
  return carried && network.model.unload_rescale;
}

HertzRadius hertz_radius(const Network& network) {
  const bool has = with_law(network.model.law, [](auto law) { return decltype(law)::Force::has_hertz_radius; });
  return has ? network.model.hertz_radius : HertzRadius::equivalent;
}

LinearContact unloading_terms(const ContactState& contact, double ri, double rj) {
  ContactRow dl = ContactRow::Zero();
  dl.head<3>() = contact.normal.transpose();
  const ContactRow relative = -0.5 / contact.overlap * dl;
  LinearContact extra;
  extra.force = contact.tangential_force * relative;
  add_torques(extra, contact, ri, rj, extra.force, contact.rolling_moment * relative, ContactMatrix::Zero(),
              ContactRow::Zero());
  return extra;
}

}  // namespace rvelab
