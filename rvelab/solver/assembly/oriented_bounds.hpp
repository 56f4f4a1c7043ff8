// Which pairs of grains that are not round are listed: of those whose circles are nearer than the skin, the ones whose
// outlines are.
//
// Along a direction n of length 1 the gap is s = n.x - h_i(n) - h_j(n), with x the branch and h the supports
// (of ellipses kernels/ellipse_overlap.hpp); no direction shows more than the distance. Where one shows s > skin, the
// pair is left out. What it takes to bring such a pair to touch is, with the cell's strain e since and |x| < reach +
// skin,
//   n.(F - I) x >= -e (reach + skin), and |d| + max |change of h| of either grain,
// so it stays apart while the displacements, turns included, sum to less than (1 - e) (reach + skin) - reach: what
// list_is_stale allows of circles too.
//
// An ellipse turned by theta: |h(p - theta) - h(p)| = (a^2 - b^2) |sin(2p - theta) sin theta|/(h(p - theta) + h(p)),
// and from h(q) >= |a cos(q) sin(q') + b sin(q) cos(q')| for any q' the sum of the two h is not below
// (a + b) |sin(2p - theta)|. So the outline moves by (a - b) |sin theta| at most. Of other shapes l stands for a - b
// (Extent::turning), the seventh of a row. In space a turn by theta moves h by l theta at most, since dh/dtheta = |x x
// n| of the support point x.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

/// Takes the pairs out of which a direction shows that they are apart by more than `skin`, m.
void keep_near_outlines(const Model& model, const Assembly& assembly, double skin, std::vector<ListedPair>& pairs);

/// What a list notes of an axis in the plane: 2 plus the tangent of half its angle, 1 to 3, the same for the axis
/// pointing the other way. 0, which files of earlier versions hold, is none.
inline double noted_axis(const Vector3& axis) {
  return 2 + (axis[0] >= 0 ? axis[1] / (1 + axis[0]) : -axis[1] / (1 - axis[0]));
}

/// How far the turn from the noted axis has moved the outline of the grain of a row at most, m: l |e_0 x e|; l where
/// none was noted.
inline double outline_moved_by_turn(double noted, const double* row) {
  if (noted == 0) return row[7];
  const double t = noted - 2, cross = ((1 - t * t) * row[6] - 2 * t * row[5]) / (1 + t * t);
  return row[7] * (cross < 0 ? -cross : cross);
}

/// How fast its turn moves it at most, m/s, beside the mean spin of the cell.
inline double outline_speed_by_turn(const double* row) { return row[7] * (row[4] < 0 ? -row[4] : row[4]); }

/// The same of a superellipsoid (grains/superellipsoid.hpp): by l theta, theta = 2 asin |v| of the turn between, with
/// asin s <= s + 0.571 s^3. `listed`: ListState::orientations.
inline double solid_moved_by_turn(const Vector3& listed, const double* row) {
  const double w0 = std::sqrt(std::max(0.0, 1 - listed.squaredNorm()));
  const Vector3 v(row[13], row[14], row[15]);
  const double s = std::min(1.0, (w0 * v - row[12] * listed - listed.cross(v)).norm());
  return row[23] * (2 * s * (1 + 0.571 * s * s));
}
/// As a list notes it: of the two quaternions of a turn the one with w >= 0.
inline Vector3 noted_turn(const double* row) { return (row[12] < 0 ? -1 : 1) * Vector3(row[13], row[14], row[15]); }

}  // namespace rvelab
