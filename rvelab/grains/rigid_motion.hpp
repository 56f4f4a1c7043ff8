// Motion of a rigid body of full inertia: orientation by a unit quaternion, angular momentum in the frame of its
// principal axes. Only + - x / and square roots, so that the bits are the same everywhere.
//
// Free motion, dL/dt = L x w with w = L/I in the body frame, goes by the midpoint rule: L1 - L0 = t Lm x wm with
// Lm = (L0 + L1)/2, and the body turns by the Cayley rotation of t wm. Both |L|^2 and the energy L.w/2 are quadratic,
// so the rule keeps them to round-off (Cooper 1987), and with this rotation the momentum in space too. It is of second
// order and reversible. A sub-step turns a grain by little, and two or three iterations are enough.
//
// Beside it the splitting into turns about the three principal axes was tried (Dullweber, Leimkuhler and McLachlan
// 1997; NO_SQUISH of Miller et al. 2002), explicit and symplectic. Tops of moments 1 2 3, 1 1.05 4, 0.2 0.9 1 of
// tests/data/grains/top.csv, 1e6 steps of a hundredth of the period:
//
//   |                                      | midpoint                | splitting
//   | largest change of the energy         | 2e-13, 1e-12, 4e-13     | 2e-5, 2e-4, 2e-5 (an oscillation)
//   | its trend over the run               | 2e-13, 1e-12, 5e-13     | 5e-10, 5e-9, 2e-10
//   | error of w after one period          | 8e-4, 1.4e-3, 1.5e-3    | 1.9e-3, 1.6e-3, 4.2e-3
//   | time                                 | 1.6 (these long steps)  | 1
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rvelab/grains/turns.hpp"

namespace rvelab {

/// Unit quaternion, body frame to cell frame; scalar part first, as in a file.
struct Turn {
  double w = 1;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
};

static inline Triple<double> triple_of(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }
static inline LaneTurn<double> lane_of(const Turn& q) { return {q.w, triple_of(q.v)}; }
static inline Turn turn_from(const LaneTurn<double>& q) { return {q.w, {q.v.x, q.v.y, q.v.z}}; }

/// First b, then a.
static inline Turn after(const Turn& a, const Turn& b) { return turn_from(after(lane_of(a), lane_of(b))); }
static inline Turn normalised(const Turn& q) { return turn_from(normalised(lane_of(q))); }
inline Turn inverse(const Turn& q) { return {q.w, -q.v}; }

/// The rotation R with R a - a = t x (R a + a)/2 for any a: by 2 atan(|t|/2) about t.
static inline Turn cayley_turn(const Eigen::Vector3d& t) { return normalised(Turn{1, 0.5 * t}); }
/// The way back: t of a turn by less than pi.
inline Eigen::Vector3d cayley_vector(const Turn& q) { return (2 / q.w) * q.v; }

/// The principal axes as columns.
static inline Eigen::Matrix3d axes_of(const Turn& q) {
  const LaneAxes<double> axes = axes_of(lane_of(q));
  Eigen::Matrix3d m;
  for (int k = 0; k < 3; ++k) m.row(k) << axes.row[k].x, axes.row[k].y, axes.row[k].z;
  return m;
}
/// Of a proper rotation.
static inline Turn turn_of(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return normalised(Turn{q.w(), q.vec()});
}

/// Free rotation for a time t (s): momentum (kg m^2/s) in the body frame, `moments` about the principal axes (kg m^2).
/// Returns t wm, the Cayley vector of the turn (axes of the body).
static inline Eigen::Vector3d rotate_freely(double t, const Eigen::Vector3d& moments, Eigen::Vector3d& momentum,
                                            Turn& q) {
  Triple<double> of_lane = triple_of(momentum);
  const Triple<double> turned = rotate_freely<double>(t, {1 / moments[0], 1 / moments[1], 1 / moments[2]}, of_lane);
  momentum = {of_lane.x, of_lane.y, of_lane.z};
  q = normalised(after(q, cayley_turn({turned.x, turned.y, turned.z})));
  return {turned.x, turned.y, turned.z};
}

}  // namespace rvelab
