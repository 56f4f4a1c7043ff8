// Points of soil against rocks as balls (Li et al. 2023, eq. 22 to 29): a ball of the solids of the point,
//
//   r_g = cbrt(3/(4 pi) V (1 - porosity)),  in the plane sqrt(V (1 - porosity)/(pi l)),  half of its side at most,
//
// of the volume V at the start (a radius that changes would do work that nobody pays; one that would overlap a rock
// there is made to touch it), or the grain that it is by its table (an overlap of a twentieth stays), touches a rock by
// contact.hpp. The force f on it acts at the contact, r from the point: the nodes get N f + (f (x) r - r (x) f)/2
// grad N, the force and its moment about the point on nodes of the point itself. Momentum and angular momentum are
// kept; the printed eq. 29, without the second term, loses r x f (`moment = false`). The velocity of the soil at the
// contact is v + W r, v and its spin W those of the grid there: what f does work on by that mapping. Of the point's own
// velocity, which differs from the grid's, friction would book another slip than it does work on (a tenth of the work
// of a rock that is dragged), and with all of f (x) r the ball, which is rigid, would be strained.
//
// Energy. Overlap and slip are of what moved soil and rock over the step before: the velocity u of the grid at the end
// of that step, the mean velocity of the rock over its sub-steps (that of its end is another where rocks shake).
// Mapping has made another velocity, v, of u since, w at the end of this step. The force does dt f.(v + w)/2 on the
// soil, and its spring gives dt f.(u + w)/2. The rock gets the force over the whole step: f times its motion in this
// step, where the spring gives half of that and half of its motion in the step before. Both differences are
// `ghost_mapping`. (All of the rock's impulse at the start of the step would need none, and makes stiff rocks ring:
// their contacts took twice as much.) Declared in rocks.hpp.
#include <algorithm>
#include <cmath>

#include "tools/mpm/bodies/touching.hpp"
#include "tools/mpm/grid/clock.hpp"
#include "tools/mpm/grid/transfer.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {

/// m/s, of the soil where a ball touches: velocity(node, i) at the point, and its spin times the arm.
template <int D, class Velocity>
Vec<D> soil_velocity(const Grid<D>& grid, const Support<D>& support, const Vec<D>& arm, const Velocity& velocity) {
  Vec<D> sum = Vec<D>::Zero();
  Mat<D> gradient;
  Lanes<D> L[D] = {};
  each_row<D>(grid.nodes.data(), grid, support,
              [&](const Node<D>* row, double across, const double* slope, const double*) {
                Lanes<D> along = {}, steep = {};
                for (int r = 0; r < 3; ++r) {
                  for (int i = 0; i < D; ++i) {
                    const double each = velocity(row[r], i);
                    along[i] += support.weight[0][r] * each;
                    steep[i] += support.slope[0][r] * each;
                  }
                }
                for (int i = 0; i < D; ++i) sum[i] += along[i] * across;
                add_gradient<D>(L, along, steep, across, slope);
              });
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j < D; ++j) gradient(i, j) = L[j][i];
  }
  return sum + 0.5 * (gradient - gradient.transpose()) * arm;
}

template <int D>
void Rocks<D>::touch_ghosts(const Grid<D>& grid, const std::vector<Point<D>>& points,
                            const std::vector<Support<D>>& supports, double dt) {
  const double begin = wall_seconds();
  const PointsByCell<D> cells(grid, points);
  std::vector<Ghost> found;
  double widest = 0, stiffest = 0;
  for (const auto& point : points) widest = std::max(widest, point.half.maxCoeff());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto& rock = all[k];
    const auto& shape = shapes[std::size_t(rock.shape)];
    cells.each_near(rock.body.centre, shape.bounding_radius() + 2.5 * widest, [&](long p) {
      const auto& point = points[std::size_t(p)];
      const double radius = balls[std::size_t(p)];
      const Vec<D> r = point.position - rock.body.centre;
      if (r.squaredNorm() > std::pow(shape.bounding_radius() + radius + widest, 2)) return;
      Vec<D> outward;
      const double gap = shape.distance(to_body<D>(rock.body.orientation, r), outward) - radius;
      if (!(gap < widest)) return;
      const auto pair = ghost_constants(int(k), radius);
      const double speed = (point.velocity - rock.body.velocity_at(r)).norm();
      const double overlap = std::max(-gap, pair.reach(point.mass, speed));
      stiffest = std::max(stiffest, pair.normal_stiffness(overlap) / point.mass);
      if (!(gap < 0)) return;
      Ghost ghost;
      ghost.point = p;
      ghost.rock = int(k);
      ghost.normal = to_world<D>(rock.body.orientation, outward);
      ghost.overlap = -gap;
      ghost.arm = -(radius - 0.5 * ghost.overlap) * ghost.normal;
      found.push_back(ghost);
    });
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.point != b.point ? a.point < b.point : a.rock < b.rock; });
  keep_ghosts(found);
  for (auto& rock : all) {
    if (sub_steps > 0) break;  // the first step: none before
    rock.mean_velocity = rock.body.velocity;
    rock.mean_spin = rock.body.spin();
  }
  for (auto& ghost : found) {
    const auto& point = points[std::size_t(ghost.point)];
    auto& rock = all[std::size_t(ghost.rock)];
    const Vec<D> r = point.position + ghost.arm - rock.body.centre;
    const Vec<D> start = soil_velocity<D>(grid, supports[std::size_t(ghost.point)], ghost.arm,
                                          [](const Node<D>& node, int i) { return node.a[i]; });  // as mapped
    const auto pair = ghost_constants(ghost.rock, balls[std::size_t(ghost.point)]);
    ghost.from_centre = r;
    ghost.moved = rock.mean_velocity + spun<D>(rock.mean_spin, r);
    const Vec<D> since = ghost.lasts ? ghost.velocity : start;
    ghost.force = ghost.contact.advance(pair, ghost.overlap, ghost.normal, since - ghost.moved, dt, ghost_loss);
    ghost_mapping += 0.5 * dt * ghost.force.dot(since - start);
    ghost.velocity = start;
    rock.impulse -= dt * ghost.force;
    rock.angular_impulse -= dt * moment<D>(r, ghost.force);
  }
  ghosts = std::move(found);
  ghost_frequency = std::sqrt(stiffest);
  soil_contacts = long(ghosts.size());
  soil_seconds += wall_seconds() - begin;
}

template <int D>
void Rocks<D>::give_ghost_forces(Grid<D>& grid, const std::vector<Support<D>>& supports) const {
  for (const auto& ghost : ghosts) {
    Lanes<D> stress[D] = {}, force = {};
    for (int i = 0; i < D; ++i) {
      force[i] = ghost.force[i];
      for (int j = 0; soil.moment && j < D; ++j)
        stress[j][i] = 0.5 * (ghost.force[i] * ghost.arm[j] - ghost.force[j] * ghost.arm[i]);
    }
    give_force<D>(grid, supports[std::size_t(ghost.point)], stress, force);
  }
}

template <int D>
double Rocks<D>::ghost_work(const Grid<D>& grid, const std::vector<Support<D>>& supports, double dt) {
  double work = 0;
  for (auto& ghost : ghosts) {
    const Vec<D> end = soil_velocity<D>(grid, supports[std::size_t(ghost.point)], ghost.arm,
                                        [](const Node<D>& node, int i) { return node.w[i]; });
    Vec<D> mean = 0.5 * (ghost.velocity + end);
    if (!soil.moment)  // the force alone does work
      mean = soil_velocity<D>(grid, supports[std::size_t(ghost.point)], Vec<D>::Zero(),
                              [](const Node<D>& node, int i) { return node.w[i] - 0.5 * node.a[i]; });
    work += ghost.force.dot(mean);
    ghost.velocity = end;
  }
  return dt * work;
}

/// The rock's part of ghost_mapping, once its mean velocity over this step is known.
template <int D>
void Rocks<D>::book_ghosts(double dt) {
  for (const auto& ghost : ghosts) {
    const auto& rock = all[std::size_t(ghost.rock)];
    const Vec<D> now = rock.mean_velocity + spun<D>(rock.mean_spin, ghost.from_centre);
    ghost_mapping -= 0.5 * dt * ghost.force.dot(ghost.moved - now);
  }
}

#define MPM_INSTANTIATE(D)                                                                                           \
  template void Rocks<D>::touch_ghosts(const Grid<D>&, const std::vector<Point<D>>&, const std::vector<Support<D>>&, \
                                       double);                                                                      \
  template void Rocks<D>::give_ghost_forces(Grid<D>&, const std::vector<Support<D>>&) const;                         \
  template double Rocks<D>::ghost_work(const Grid<D>&, const std::vector<Support<D>>&, double);                      \
  template void Rocks<D>::book_ghosts(double);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
