// Soil met at the surface of rocks: as with bodies (bodies/surface.cpp), and the impulses move the rock too. Where they
// touch is found in touching.cpp. Declared in rocks.hpp.
//
//   K J = -u,   K = (sum N_I^2/m_I) 1 + 1/M + (r x) I^-1 (r x)^T
//
// u: velocity of the soil at a point of the surface less that of the rock there, r from the centre of the rock. J n >=
// 0 and |J_t| <= mu J_n; where it slides, J_n is that with which the soil does not enter: no stiffness, no time step.
#include <algorithm>

#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {

template <int D>
void Rocks<D>::start_motion() {
  motion.clear();
  for (const auto& rock : all) motion.push_back({rock.body.velocity, rock.body.spin()});
}

template <int D>
void Rocks<D>::predict_motion(const Vec<D>& gravity, double dt) {
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const auto& rock = all[k];
    motion[k].velocity += dt * (gravity + rock.mean_force / rock.body.mass).cwiseProduct(rock.body.free);
    motion[k].spin += rock.body.spin_of(dt * rock.mean_torque);
  }
}

/// The sweeps of one step go on with the impulses of the last.
template <int D>
void Rocks<D>::press(std::size_t point, Grid<D>& grid) {
  auto& here = surface[point];
  if (here.index == at_node) return;
  const auto number = std::size_t(here.soil.owner);
  here.soil.now = step * to_world<D>(all[number].body.orientation, pressed[number][here.index]);
  push(point, here.soil.now, grid, true);
}

template <int D>
void Rocks<D>::forget_pressed() {
  for (auto& each : pressed) std::fill(each.begin(), each.end(), Vec<D>::Zero());
}

template <int D>
void Rocks<D>::keep_pressed() {
  for (const auto& here : surface) {
    if (here.index == at_node) continue;
    const auto number = std::size_t(here.soil.owner);
    pressed[number][here.index] = to_body<D>(all[number].body.orientation, Vec<D>(here.soil.now / step));
  }
}

/// An impulse (N s) on the soil at a point of a rock, and its opposite on the rock.
template <int D>
void Rocks<D>::push(std::size_t point, const Vec<D>& impulse, Grid<D>& grid, bool end) {
  const auto& here = surface[point];
  const auto& rock = all[std::size_t(here.soil.owner)].body;
  auto& moved = motion[std::size_t(here.soil.owner)];
  here.soil.push(grid, impulse, end);
  moved.velocity -= (impulse / rock.mass).cwiseProduct(rock.free);
  moved.spin -= rock.spin_of(moment<D>(here.r, impulse));
}

/// At the start of a step nodes in rocks alone are held. Points of soil hardly feel what impulses at the surface do to
/// nodes behind it: the next step would begin with the same velocity into the rock, and these would take it away again
/// and strain the soil by what its points never do. Five rocks in 8 x 8 x 8 cells pressed from 50 to 200 kPa: mapping
/// gains 11 % of the work of the stress with them, and takes 3 % without.
template <int D>
void Rocks<D>::hold(std::size_t k, Grid<D>& grid, bool end) {
  auto& here = surface[k];
  auto& point = here.soil;
  if (!end && here.index != at_node) return;
  const auto& moved = motion[std::size_t(point.owner)];
  Vec<D> relative = point.velocity(grid, end) - moved.velocity - spun<D>(moved.spin, here.r);
  relative -= here.mobility * point.now;  // without this point's impulse
  relative += here.gap / step * point.normal;
  Vec<D> impulse = Vec<D>::Zero();
  const double across = relative.dot(point.normal);
  const Vec<D> stuck = -here.resistance * relative;
  const double pressing = stuck.dot(point.normal);
  if (pressing > 0 || across < 0) {
    impulse = stuck;
    Vec<D> along = stuck - pressing * point.normal;
    const double size = along.norm(), friction = soil.friction;
    if (!soil.rough && (size > friction * pressing || pressing <= 0)) {
      if (size > 0) along /= size;
      const Vec<D> direction = point.normal + friction * along;
      const double gives = point.normal.dot(here.mobility * direction);
      impulse = across < 0 && gives > 0 ? Vec<D>(-across / gives * direction) : Vec<D>(Vec<D>::Zero());
    } else if (pressing <= 0) {
      impulse.setZero();
    }
  }
  const Vec<D> more = impulse - point.now;
  if (more.isZero(0)) return;
  point.now = impulse;
  push(k, more, grid, end);
}

/// An impulse J that gives the soil the work A loses J.(U + U')/2 - A, U and U' the velocity of the rock there at the
/// start and at the end of the step: over a step the rock has the sum of both impulses as a force.
template <int D>
void Rocks<D>::book_surface(const Grid<D>& grid, const Planes<D>& planes) {
  for (const auto& here : surface) {
    const auto& point = here.soil;
    auto& rock = all[std::size_t(point.owner)];
    const Vec<D> impulse = point.at_start + point.at_end;
    rock.impulse -= impulse;
    rock.angular_impulse -= moment<D>(here.r, impulse);
    double work = 0;
    for (int j = 0; j < point.count; ++j) {
      const auto& node = grid.nodes[point.node[j]];
      for (int i = 0; i < D; ++i) {
        if (planes.holds(point.node[j], i)) continue;
        work += point.weight[j] * work_at(node, i, point.at_start[i], point.at_end[i]);
      }
    }
    work_on_soil += work;
    const auto& end = motion[std::size_t(point.owner)];
    const Vec<D> mean = 0.5 * (rock.body.velocity_at(here.r) + end.velocity + spun<D>(end.spin, here.r));
    surface_loss += impulse.dot(mean) - work;
  }
}

#define MPM_INSTANTIATE(D)                                       \
  template void Rocks<D>::start_motion();                        \
  template void Rocks<D>::predict_motion(const Vec<D>&, double); \
  template void Rocks<D>::press(std::size_t, Grid<D>&);          \
  template void Rocks<D>::forget_pressed();                      \
  template void Rocks<D>::keep_pressed();                        \
  template void Rocks<D>::hold(std::size_t, Grid<D>&, bool);     \
  template void Rocks<D>::book_surface(const Grid<D>&, const Planes<D>&);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
