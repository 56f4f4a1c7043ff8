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

/// h, h', h'' of a grain in the direction of the contact; those of j lie opposite.
struct Support {
  double reach, turned, bend, flattening;
  double radius_of_curvature() const { return reach + bend; }
};

Support support_of(Shape shape, const GrainState& grain, double along, double across) {
  return with_shape(shape, [&](auto is) -> Support {
    using By = typename decltype(is)::By;
    if constexpr (By::round || By::rigid) {
      return {along, across, 0, 0};
    } else {
      const Bend bend = By::bend(grain, along, across);
      return {along, across, bend.second, bend.flattening};
    }
  });
}

/// z-component of a x B for the columns of B.
ContactRow cross_z(const Vector3& a, const ContactMatrix& b) { return a.x() * b.row(1) - a.y() * b.row(0); }

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

LinearContact linearised(const InteractionState& interaction, double ri, double rj) {
  LinearContact linear = linearised(static_cast<const ContactState&>(interaction), ri, rj, Slip::consistent);
  const Vector3& n = interaction.normal;
  ContactMatrix dm = ContactMatrix::Zero();
  dm.leftCols<3>() = interaction.twisting_moment / interaction.length * (Matrix3::Identity() - n * n.transpose());
  const Matrix3 twist = interaction.twisting_stiffness * n * n.transpose();
  dm.middleCols<3>(3) += twist;
  dm.rightCols<3>() -= twist;
  linear.torque_i -= dm;
  linear.torque_j += dm;
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
  const ContactRow relative = -contact.stiffness_growth * dl;
  LinearContact extra;
  extra.force = contact.tangential_force * relative;
  add_torques(extra, contact, ri, rj, extra.force, contact.rolling_moment * relative, ContactMatrix::Zero(),
              ContactRow::Zero());
  return extra;
}

LinearOutlineContact linearised_outlines(Shape shape, const ContactState& contact, const GrainState& grain_i,
                                         const GrainState& grain_j, HertzRadius hertz_radius) {
  const Vector3& n = contact.normal;
  const Vector3 t(-n.y(), n.x(), 0);
  const double half = 0.5 * contact.overlap, along_t = contact.tangential_force.dot(t);
  const Support i = support_of(shape, grain_i, contact.arm_i.dot(n) + half, contact.arm_i.dot(t));
  const Support j = support_of(shape, grain_j, half - contact.arm_j.dot(n), -contact.arm_j.dot(t));

  ContactMatrix db = ContactMatrix::Zero();
  db.block<3, 3>(0, 0).setIdentity();
  ContactRow turn_i = ContactRow::Zero(), turn_j = ContactRow::Zero();
  turn_i[5] = turn_j[8] = 1;
  const ContactRow along = n.transpose() * db, across = t.transpose() * db;

  const ContactRow overlap = -along - i.turned * turn_i - j.turned * turn_j;
  const ContactRow turn = (across + i.bend * turn_i + j.bend * turn_j) /
                          (i.radius_of_curvature() + j.radius_of_curvature() - contact.overlap);
  const ContactRow slip = across - (i.reach - half) * turn_i - (j.reach - half) * turn_j;
  const ContactRow moment = -contact.rolling_stiffness * (turn_j - turn_i);

  // (delta/R*) dR*: what the change of the radius is to the root of delta R*.
  ContactRow radius = ContactRow::Zero();
  if (hertz_radius == HertzRadius::curvature) {
    const double sharp_i = 1 / i.radius_of_curvature(), sharp_j = 1 / j.radius_of_curvature();
    radius = contact.overlap / (sharp_i + sharp_j) *
             (sharp_i * i.flattening * (turn - turn_i) + sharp_j * j.flattening * (turn - turn_j));
  }

  LinearOutlineContact linear;
  linear.opening = -(overlap + radius);
  const ContactRow normal = contact.normal_stiffness * overlap + 0.5 * contact.normal_force / contact.overlap * radius;
  linear.law.force =
      n * (normal - along_t * turn) + t * (contact.normal_force * turn - contact.tangential_stiffness * slip);
  const ContactMatrix arm_i =
      n * (-i.turned * turn_i - 0.5 * overlap) + t * ((i.reach - half) * turn + i.bend * (turn - turn_i));
  const ContactMatrix arm_j = arm_i - db;
  const Vector3 force = contact.force();
  const auto set_torques = [&](LinearContact& rows, const ContactMatrix& of_i, const ContactMatrix& of_j,
                               const ContactRow& rolling) {
    rows.torque_i.setZero();
    rows.torque_j.setZero();
    // r x F is r_x F_y - r_y F_x; the change of the arm enters as -(F x dr).
    rows.torque_i.row(2) = cross_z(force, of_i) - cross_z(contact.arm_i, rows.force) - rolling;
    rows.torque_j.row(2) = -cross_z(force, of_j) + cross_z(contact.arm_j, rows.force) + rolling;
  };
  set_torques(linear.law, arm_i, arm_j, moment);

  const ContactRow relative = contact.stiffness_growth * (overlap + radius);
  linear.unloading.force = contact.tangential_force * relative;
  set_torques(linear.unloading, ContactMatrix::Zero(), ContactMatrix::Zero(), contact.rolling_moment.z() * relative);
  return linear;
}

}  // namespace rvelab
