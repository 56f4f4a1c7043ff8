// One contact of grains that are not round, linearised (formulas at the head of outline_linear.hpp).
#include "rvelab/measure/outline_linear.hpp"

namespace rvelab {
namespace {

/// h, h', h'' of a grain in the direction of the contact; those of j lie opposite.
struct Support {
  double reach, turned, bend, flattening;
  double radius_of_curvature() const { return reach + bend; }
};

Support support_of(Shape shape, const GrainState& grain, double along, double across) {
  return with_shape(shape, [&](auto is) -> Support {
    using By = typename decltype(is)::By;
    if constexpr (By::round) {
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

  const ContactRow relative = 0.5 / contact.overlap * (overlap + radius);
  linear.unloading.force = contact.tangential_force * relative;
  set_torques(linear.unloading, ContactMatrix::Zero(), ContactMatrix::Zero(), contact.rolling_moment.z() * relative);
  return linear;
}

}  // namespace rvelab
