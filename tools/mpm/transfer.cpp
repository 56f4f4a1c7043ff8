// What points give to nodes and take from them: where the time of the continuum goes.
#include "tools/mpm/transfer.hpp"

#include "tools/mpm/rocks.hpp"
#include "tools/mpm/solver.hpp"

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
  if (rocks && rocks->soil.ghosts) give_ghost_forces();
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

template void Solver<2>::map_momentum();
template void Solver<2>::map_force();
template void Solver<2>::gradients(double);
template void Solver<2>::move_points(double);
template void Solver<3>::map_momentum();
template void Solver<3>::map_force();
template void Solver<3>::gradients(double);
template void Solver<3>::move_points(double);

}  // namespace mpm
