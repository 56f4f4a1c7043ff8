#include "tools/mpm/solver.hpp"

#include <sstream>

#include "tools/mpm/clock.hpp"
#include "tools/mpm/fluid.hpp"
#include "tools/mpm/rocks.hpp"
#include "tools/mpm/transfer.hpp"

namespace mpm {
namespace {

constexpr int slab_rows = 4;  // points of one slab and of the next but one share no node

constexpr double farthest_node = 1e9;  // their numbers are int

template <int D>
[[noreturn]] void throw_flown(const Vec<D>& at, const std::string& material, double time) {
  std::ostringstream words;
  words << "at " << time << " s a point of material " << material << " is at " << at.transpose()
        << " m, more than 1e9 cells from 0; take a smaller time.cfl, or a load that the soil can carry";
  throw std::runtime_error(words.str());
}

int slab_of(int row) { return row >= 0 ? row / slab_rows : -((-row + slab_rows - 1) / slab_rows); }

}  // namespace

template <int D>
Solver<D>::Solver(int threads) : workers(threads) {}
template <int D>
Solver<D>::~Solver() = default;

template <int D>
const MaterialGroup<D>& Solver<D>::group_of(long point) const {
  return *std::find_if(groups.begin(), groups.end(),
                       [&](const auto& group) { return point < group.first + group.count; });
}

template <int D>
double Solver<D>::stable_step() const {
  struct Extremes {
    double lightest = 1e300, fastest = 0;
    void add(double density, double square) {
      lightest = std::min(lightest, density);
      fastest = std::max(fastest, square);
    }
  };
  double wave = 0, fastest = 0;
  for (const auto& group : groups) {
    std::vector<Extremes> pieces((group.count + chunk - 1) / chunk);
    workers.for_each(std::int64_t(pieces.size()), [&](std::int64_t piece) {
      Extremes here;  // not in place: neighbours share cache lines
      for (long k = piece * chunk; k < std::min(group.count, long(piece + 1) * chunk); ++k) {
        const auto& point = points[group.first + k];
        here.add(point.mass / point.volume, point.velocity.squaredNorm());
      }
      pieces[piece] = here;
    });
    Extremes all;
    for (const auto& piece : pieces) all.add(piece.lightest, piece.fastest);
    fastest = std::max(fastest, all.fastest);
    if (group.count > 0) wave = std::max(wave, group.material->wave_modulus() / all.lightest);
  }
  // Rocks and plates alone move by no more than a hundredth of a cell a step from rest.
  double pull = std::max(1e-9, options.gravity.norm());
  for (const auto& body : bodies.all) {
    if (body.pressed()) pull = std::max(pull, body.plate->acceleration());
  }
  const double alone = std::sqrt(0.02 * grid.cell.minCoeff() / pull);
  const double dt =
      points.empty() ? alone : options.cfl * grid.cell.minCoeff() / (std::sqrt(wave) + std::sqrt(fastest));
  // A boundary or body faster than any wave must not jump over the soil: a fifth of a cell a step at most.
  double driven = 0;
  for (const double then : {time, time + dt}) {
    each_driven([&](const auto& each) { driven = std::max(driven, each.velocity_at(then).norm()); });
  }
  if (!rocks) return driven > 0 ? std::min(dt, 0.2 * grid.cell.minCoeff() / driven) : dt;
  driven = std::max(driven, rocks->fastest());
  const double until = std::min(dt, options.cfl / std::max(1e-300, rocks->ghost_frequency));
  return driven > 0 ? std::min(until, 0.2 * grid.cell.minCoeff() / driven) : until;
}

template <int D>
void Solver<D>::place_grid() {
  if (follow_axis < 0) return;
  const auto& plane = planes.all[followed];
  const double span = plane.node * first_cell[follow_axis] + plane.velocity.displacement(time)[follow_axis];
  grid.cell[follow_axis] = span / plane.node;
}

template <int D>
void Solver<D>::find_supports() {
  const long n = long(points.size());
  supports_.resize(points.size());
  const long pieces = (n + chunk - 1) / chunk;
  using Index = typename Grid<D>::Index;
  std::vector<Index> low(pieces), high(pieces);
  const Vec<D> per_m = grid.cell.cwiseInverse();
  workers.for_each(pieces, [&](std::int64_t piece) {
    Index least, most;  // not in place: neighbours share cache lines (two threads: 2.09 s of 3.09, so 1.75)
    for (int i = 0; i < D; ++i) least[i] = 1 << 30, most[i] = -(1 << 30);
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      for (int i = 0; i < D; ++i) {
        const double xi = (points[k].position[i] - grid.anchor[i]) * per_m[i];
        if (!(std::abs(xi) < farthest_node)) throw_flown(points[k].position, group_of(k).name, time);
        supports_[k].node[i] = shape_along_axis(options.shape, xi, per_m[i], points[k].half[i] * per_m[i],
                                                supports_[k].weight[i], supports_[k].slope[i]);
        least[i] = std::min(least[i], supports_[k].node[i]);
        most[i] = std::max(most[i], supports_[k].node[i] + 2);
      }
    }
    low[piece] = least;
    high[piece] = most;
  });
  for (long piece = 1; piece < pieces; ++piece) {
    for (int i = 0; i < D; ++i) {
      low[0][i] = std::min(low[0][i], low[piece][i]);
      high[0][i] = std::max(high[0][i], high[piece][i]);
    }
  }
  const bool grown = grid.cover(low[0], high[0], Grid<D>::most_for(n));
  if (grown || planes.changed(time)) planes.rebuild(grid, time);
}

/// Points by slabs, within them in their order: pieces of points are counted, then each puts its own in place.
template <int D>
void Solver<D>::sort_into_slabs() {
  const int first = slab_of(grid.low[D - 1]), last = slab_of(grid.low[D - 1] + grid.count[D - 1]);
  const long n = long(points.size()), pieces = (n + chunk - 1) / chunk, slabs = last - first + 1;
  const auto each_slab = [&](std::int64_t piece, const auto& visit) {
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      visit(k, slab_next_[piece * slabs + slab_of(supports_[k].node[D - 1]) - first]);
    }
  };
  slab_next_.assign(pieces * slabs, 0);
  workers.for_each(pieces, [&](std::int64_t piece) { each_slab(piece, [](long, long& count) { ++count; }); });
  slab_begin_.assign(1, 0);
  long at = 0;
  for (long slab = 0; slab < slabs; ++slab) {
    for (long piece = 0; piece < pieces; ++piece) {
      const long count = slab_next_[piece * slabs + slab];
      slab_next_[piece * slabs + slab] = at;
      at += count;
    }
    slab_begin_.push_back(at);
  }
  order_.resize(points.size());
  workers.for_each(pieces,
                   [&](std::int64_t piece) { each_slab(piece, [&](long k, long& next) { order_[next++] = k; }); });
  // Whether a slab comes with the even or the odd ones must not depend on where the box begins.
  if ((first & 1) != 0) slab_begin_.insert(slab_begin_.begin(), 0);
}

template <int D>
void Solver<D>::clear(Grid<D>& of) {
  const long n = long(of.nodes.size());
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    const long from = long(piece) * chunk;
    of.clear(from, std::min(n, from + chunk));
  });
}

template <int D>
void Solver<D>::start_velocities(Phase<D> phase) {
  over_nodes(phase.grid, [](auto& node) {
    for (int i = 0; i < D; ++i) node.a[i] = node.v[i] = node.v[i] / node.mass;
  });
  phase.planes.fold_momentum(phase.grid, time);
  phase.planes.set_start(phase.grid, time);
  phase.planes.keep_mapped(phase.grid);
  phase.bodies.detect_contact(phase.grid, phase.planes, points, time, workers);
  phase.bodies.set_start(phase.grid, time);
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
  if (rocks) bodies.predict_rocks(options.gravity, dt);
  bodies.set_end(grid, planes, time + dt);
  planes.set_end(grid, time + dt);
  if (planes.absorb()) book_dashpots(dt);
  take_changes(solid(), dt);
  advance_free(dt);
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
  if (rocks->soil.ghosts) rocks->work_on_soil += ghost_work(dt);
  rocks->advance([&](double then) { return walls_at<D>(grid, planes, bodies, then); }, options.gravity, time, dt,
                 Plates{bodies, planes.all.size()});
  rocks->seconds += wall_seconds() - begin;
}

template <int D>
double Solver<D>::rock_work() const {
  return rocks ? rocks->work_on_soil : 0;
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
void Solver<D>::stresses(double dt) {
  const double begin = wall_seconds();
  for (auto& group : groups) group.material->advance(points.data() + group.first, group.count, dt, workers);
  material_seconds += wall_seconds() - begin;
  const long n = long(points.size());
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      auto& point = points[k];
      const Mat<D> dH = finite_increment<D>(point.gradient);
      point.strain += 0.5 * (dH + dH.transpose());
      point.volume *= (Mat<D>::Identity() + dH).determinant();
      point.F = (point.F + dH * point.F).eval();
      point.work += 0.5 * point.volume * point.stress.cwiseProduct(point.gradient).sum();
    }
  });
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
  bodies.set_start(grid, time + dt);
  planes.set_start(grid, time + dt);
}

/// Grid, supports and slabs of this step's places.
template <int D>
void Solver<D>::begin_step() {
  place_grid();
  find_supports();
  sort_into_slabs();
  clear(grid);
}

template <int D>
void Solver<D>::step(double dt) {
  if (fluid) return saturated_step(dt);
  if (points.empty()) return rocks_alone(dt);
  const double begin = wall_seconds(), before = material_seconds;
  begin_step();
  bodies.place_plates(grid, planes, time);
  if (rocks) rocks->step = dt;
  map_momentum();
  start_velocities(solid());
  if (rocks && rocks->soil.ghosts) touch_ghosts(dt);
  if (options.scheme == Scheme::usf) {
    gradients(dt);
    stresses(dt);
    map_force();
    end_velocities(dt);
    if (loads.any()) add_load_work(dt);
    move_points(dt);
  } else {
    map_force();
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

template class Solver<2>;
template class Solver<3>;

}  // namespace mpm
