// The order of a step: dry or with rocks, saturated, and of rocks alone. Declared in solver.hpp.
#include "tools/mpm/grid/clock.hpp"
#include "tools/mpm/step/solver.hpp"

namespace mpm {

template <int D>
void Solver<D>::step(double dt) {
  if (fluid) return saturated_step(dt);
  if (points.empty()) return rocks_alone(dt);
  const double begin = wall_seconds(), before = material_seconds;
  const bool ghosts = rocks && rocks->soil.ghosts;
  begin_step();
  bodies.place_plates(grid, planes, time);
  if (rocks) rocks->step = dt;
  map_momentum();
  start_velocities(solid());
  if (ghosts) rocks->touch_ghosts(grid, points, supports_, dt);
  if (options.scheme == Scheme::usf) {
    gradients(dt);
    stresses(dt);
    map_force();
    if (ghosts) rocks->give_ghost_forces(grid, supports_);
    end_velocities(dt);
    if (loads.any()) add_load_work(dt);
    move_points(dt);
  } else {
    map_force();
    if (ghosts) rocks->give_ghost_forces(grid, supports_);
    end_velocities(dt);
    if (loads.any()) add_load_work(dt);
    move_points(dt);
    second_map(dt);
    gradients(dt);
    stresses(dt);
  }
  time += dt;
  ++steps;
  grid_seconds += wall_seconds() - begin - (material_seconds - before);
}

template <int D>
void Solver<D>::saturated_step(double dt) {
  const double begin = wall_seconds(), before = material_seconds;
  begin_step();
  fluid->begin_step(grid, points, time, steps == 0);
  clear(fluid->grid);
  map_momentum();
  map_water_momentum();
  start_velocities(solid());
  start_velocities(water());
  gradients(dt);
  stresses(dt);
  const double assembling = wall_seconds();
  assemble_water();
  fluid->seconds += wall_seconds() - assembling;
  map_saturated_force();
  planes.fold_force(grid);
  fluid->planes.fold_force(fluid->grid);
  predict_velocities(dt);
  const double solving = wall_seconds();
  project(dt);
  fluid->seconds += wall_seconds() - solving;
  if (planes.absorb()) book_dashpots(dt);
  bodies.book_reactions(grid, planes);
  fluid->bodies.book_reactions(fluid->grid, fluid->planes);
  planes.unfold(grid);
  fluid->planes.unfold(fluid->grid);
  balance_water(dt);
  take_changes(solid(), dt);
  take_changes(water(), dt);
  add_load_work(dt);
  move_water(dt);
  move_points(dt);
  time += dt;
  ++steps;
  grid_seconds += wall_seconds() - begin - (material_seconds - before);
}

/// A step of rocks without soil.
template <int D>
void Solver<D>::rocks_alone(double dt) {
  const double begin = wall_seconds();
  place_grid();
  bodies.place_plates(grid, planes, time);
  advance_free(dt);
  time += dt;
  ++steps;
  grid_seconds += wall_seconds() - begin;
}

template <int D>
void Solver<D>::start_velocities(Phase<D> phase) {
  over_nodes(phase.grid, [](auto& node) {
    for (int i = 0; i < D; ++i) node.a[i] = node.v[i] = node.v[i] / node.mass;
  });
  phase.planes.fold_momentum(phase.grid, time);
  phase.planes.set_start(phase.grid, time);
  phase.planes.keep_mapped(phase.grid);
  phase.contact.detect(phase.grid, phase.planes, phase.bodies, phase.rocks, points, time, workers);
  phase.contact.hold_start(phase.grid, phase.bodies, phase.rocks, time);
  phase.planes.set_start(phase.grid, time);
}

template <int D>
void Solver<D>::end_velocities(double dt) {
  planes.fold_force(grid);
  over_nodes(grid, [&](auto& node) {
    for (int i = 0; i < D; ++i) node.w[i] = node.v[i] + dt * (node.w[i] / node.mass);
  });
  if (planes.absorb()) add_dashpots(dt);
  bodies.predict_plates(time, dt);
  if (rocks) rocks->predict_motion(options.gravity, dt);
  contact_.hold_end(grid, bodies, rocks.get(), time + dt);
  bodies.book_reactions(grid, planes);
  if (rocks) rocks->book_surface(grid, planes);
  planes.set_end(grid, time + dt);
  if (planes.absorb()) book_dashpots(dt);
  take_changes(solid(), dt);
  advance_free(dt);
}

/// MUSL: nodal velocities from what the points have now, at the weights that the step began with.
template <int D>
void Solver<D>::second_map(double dt) {
  clear(grid);
  map_momentum();
  over_nodes(grid, [](auto& node) {
    for (int i = 0; i < D; ++i) node.a[i] = node.v[i] = node.v[i] / node.mass;
  });
  planes.fold_momentum(grid, time + dt);
  contact_.hold_start(grid, bodies, rocks.get(), time + dt);
  planes.set_start(grid, time + dt);
}

/// Plates without rocks take the step as one.
template <int D>
void Solver<D>::advance_free(double dt) {
  bodies.sum_plate_forces(grid, time, dt);
  if (rocks) {
    advance_rocks(dt);
  } else {
    bodies.kick_plates({}, 0, 0.5 * dt);
    bodies.drift_plates(dt);
    bodies.kick_plates({}, 0, 0.5 * dt);
  }
  bodies.end_plates(dt);
}

/// Their contacts with each other and with walls, and the impulses of the soil.
template <int D>
void Solver<D>::advance_rocks(double dt) {
  struct Plates {
    Bodies<D>& bodies;
    std::size_t first;
    void kick(const std::vector<Vec<D>>& forces, double h) const { bodies.kick_plates(forces, first, h); }
    void drift(double h) const { bodies.drift_plates(h); }
  };
  const double begin = wall_seconds();
  if (rocks->soil.ghosts) rocks->work_on_soil += rocks->ghost_work(grid, supports_, dt);
  rocks->advance([&](double then) { return walls_at<D>(grid, planes, bodies, then); }, options.gravity, time, dt,
                 Plates{bodies, planes.all.size()});
  rocks->seconds += wall_seconds() - begin;
}

#define MPM_INSTANTIATE(D) template void Solver<D>::step(double);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
