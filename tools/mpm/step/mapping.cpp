// What points give to nodes and take from them: where the time of the continuum goes. Declared in solver.hpp.
#include "tools/mpm/grid/clock.hpp"
#include "tools/mpm/grid/transfer.hpp"
#include "tools/mpm/step/solver.hpp"

namespace mpm {

template <int D>
void Solver<D>::map_momentum() {
  over_slabs([&](long k) {
    const auto& point = points[k];
    give_momentum<D>(grid, supports_[k], point.mass, point.velocity, point.affine, options.affine);
  });
}

template <int D>
void Solver<D>::map_force() {
  const bool loaded = loads.any();
  Vec<D> frame = Vec<D>::Zero();
  if (loaded) frame = frame_acceleration();
  over_slabs([&](long k) {
    const auto& point = points[k];
    Lanes<D> stress[D] = {}, force = {};
    Vec<D> b = options.gravity;
    if (body_force) b += body_force(point.position, time);
    if (loaded) b -= frame;
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) {
        stress[j][i] = -point.volume * (point.stress(i, j) + (i == j ? options.surface_pressure : 0));
      }
      force[i] = point.mass * b[i];
    }
    if (loaded) stress[D - 1][D - 1] -= point.volume * loads.strip_pressure(point.position[0], time);
    give_force<D>(grid, supports_[k], stress, force);
  });
}

template <int D>
void Solver<D>::gradients(double dt) {
  const Node<D>* nodes = grid.nodes.data();
  const long n = long(points.size());
  const double pressure = options.surface_pressure;
  sums_.assign((n + chunk - 1) / chunk, 0);
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    double work = 0;
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      auto& point = points[k];
      const auto& support = supports_[k];
      Lanes<D> L[D] = {};
      each_row<D>(nodes, grid, support, [&](const Node<D>* row, double across, const double* slope, const double*) {
        Lanes<D> along = {}, steep = {};
        for (int r = 0; r < 3; ++r) {
          for (int i = 0; i < Node<D>::lanes; ++i) {
            along[i] += support.weight[0][r] * row[r].v[i];
            steep[i] += support.slope[0][r] * row[r].v[i];
          }
        }
        add_gradient<D>(L, along, steep, across, slope);
      });
      Mat<D> step;
      for (int i = 0; i < D; ++i) {
        for (int j = 0; j < D; ++j) step(i, j) = dt * L[j][i];
      }
      // USF has the velocities that points came with, at where they came to; MUSL those that they went with, at where
      // they went from.
      point.gradient = options.scheme == Scheme::usf ? strain_of_step<D>(step) : Mat<D>(-strain_of_step<D>(-step));
      if (options.scheme == Scheme::musl) point.affine = carried_gradient<D>(point.affine, dt);
      const double half = 0.5 * point.volume * point.stress.cwiseProduct(point.gradient).sum();
      point.work += half;
      work += half + 0.5 * point.volume * pressure * point.gradient.trace();
    }
    sums_[piece] = work;
  });
  for (const double each : sums_) nodal_energy -= each;
}

template <int D>
void Solver<D>::stresses(double dt) {
  const double begin = wall_seconds();
  for (auto& group : groups) group.material->advance(points.data() + group.first, group.count, dt, workers);
  material_seconds += wall_seconds() - begin;
  over(long(points.size()), [&](long k) {
    auto& point = points[k];
    const Mat<D> dH = finite_increment<D>(point.gradient);
    point.strain += 0.5 * (dH + dH.transpose());
    point.volume *= (Mat<D>::Identity() + dH).determinant();
    point.F = (point.F + dH * point.F).eval();
    point.work += 0.5 * point.volume * point.stress.cwiseProduct(point.gradient).sum();
  });
}

template <int D>
void Solver<D>::take_changes(Phase<D> phase, double dt) {
  phase.planes.unfold(phase.grid);
  auto& nodes = phase.grid.nodes;
  const long n = long(nodes.size());
  // Points fall by dt w, the work that nodes get is that of the mean velocity: heights are half a step late. So is the
  // stress of MUSL, and the two nearly cancel.
  const bool heights = &phase.grid == &grid && options.scheme == Scheme::usf;
  const Vec<D> late = heights ? Vec<D>(0.5 * dt * options.gravity) : Vec<D>(Vec<D>::Zero());
  sums_.assign((n + chunk - 1) / chunk, 0);
  workers.for_each(std::int64_t(sums_.size()), [&](std::int64_t piece) {
    double gained = 0;  // not in place: neighbours share cache lines
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      auto& node = nodes[k];
      if (!(node.mass > 0)) continue;
      double change = 0;
      for (int i = 0; i < D; ++i) {
        const double mapped = node.a[i];
        node.a[i] = node.w[i] - mapped;
        change += node.a[i] * (0.5 * (node.w[i] + mapped) + late[i]);
      }
      gained += node.mass * change;
    }
    sums_[piece] = gained;
  });
  for (const double each : sums_) phase.nodal_energy += each;
  phase.planes.react(phase.grid, dt, options.pic_fraction);
}

/// Of the mean velocities of the step at the nodes; strips, over the points' gradients.
template <int D>
void Solver<D>::add_load_work(double dt) {
  const Vec<D> frame = frame_acceleration();
  const auto power = [&](const Grid<D>& of, const Vec<D>& b) {
    double sum = 0;
    for (const auto& node : of.nodes) {
      for (int i = 0; i < D; ++i) sum += node.mass * b[i] * (node.w[i] - 0.5 * node.a[i]);
    }
    return sum;
  };
  load_work -= dt * power(grid, frame);
  if (fluid) {
    load_work -= dt * power(fluid->grid, frame);
    fluid->gravity_work += dt * power(fluid->grid, options.gravity);
  }
  if (loads.strips.empty()) return;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double pressure = loads.strip_pressure(points[k].position[0], time);
    if (pressure == 0) continue;
    Taken<D> taken;
    take_velocity<D>(grid, supports_[k], taken);
    const double mean = 0.5 * (points[k].gradient(D - 1, D - 1) + dt * taken.gradient[D - 1][D - 1]);
    load_work -= points[k].volume * pressure * mean;
  }
}

template <int D>
void Solver<D>::move_points(double dt) {
  const long n = long(points.size());
  const double pic = options.pic_fraction, pressure = options.surface_pressure;
  const bool affine = options.affine;
  sums_.assign((n + chunk - 1) / chunk, 0);
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    double work = 0;
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      auto& point = points[k];
      Taken<D> taken;
      Mat<D> gradient;
      take_velocity<D>(grid, supports_[k], taken);
      for (int i = 0; i < D; ++i) {
        point.velocity[i] = pic * taken.w[i] + (1 - pic) * (point.velocity[i] + taken.added[i]);
        point.position[i] += dt * taken.w[i];
        for (int j = 0; j < D; ++j) gradient(i, j) = taken.gradient[j][i];
      }
      work += 0.5 * dt * point.volume * (point.stress.cwiseProduct(gradient).sum() + pressure * gradient.trace());
      if (affine) point.affine = gradient;
      if (options.scheme == Scheme::usf) point.affine = carried_gradient<D>(point.affine, dt);
    }
    sums_[piece] = work;
  });
  for (const double each : sums_) nodal_energy += each;
}

#define MPM_INSTANTIATE(D)                                 \
  template void Solver<D>::map_momentum();                 \
  template void Solver<D>::map_force();                    \
  template void Solver<D>::gradients(double);              \
  template void Solver<D>::stresses(double);               \
  template void Solver<D>::take_changes(Phase<D>, double); \
  template void Solver<D>::add_load_work(double);          \
  template void Solver<D>::move_points(double);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
