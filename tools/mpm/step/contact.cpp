#include "tools/mpm/step/contact.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "tools/mpm/grid/clock.hpp"

namespace mpm {

template <int D, class Visit>
void each_surface_point(Bodies<D>& bodies, Rocks<D>* rocks, const Visit& visit) {
  for (auto& point : bodies.surface) visit(point);
  if (rocks == nullptr) return;
  for (auto& point : rocks->surface) visit(point.soil);
}

template <int D>
void SurfaceContact<D>::detect(const Grid<D>& grid, const Planes<D>& planes, Bodies<D>& bodies, Rocks<D>* rocks,
                               const std::vector<Point<D>>& soil, double time, rvelab::Workers& workers) {
  workers_ = &workers;
  runs_.clear();
  bodies.detect_contact(grid, planes, soil, time, workers);
  if (rocks == nullptr) return;
  rocks->detect_soil(grid, planes, bodies.shape, soil, workers);
  order_runs(grid, bodies, *rocks);
}

template <int D>
void SurfaceContact<D>::hold_start(Grid<D>& grid, Bodies<D>& bodies, Rocks<D>* rocks, double time) {
  if (rocks != nullptr) rocks->start_motion();
  bodies.hold_nodes(grid, time, false);
  each_surface_point(bodies, rocks, [](auto& point) { point.at_start.setZero(), point.at_end.setZero(); });
  sweep(grid, bodies, rocks, time, false);
}

template <int D>
void SurfaceContact<D>::hold_end(Grid<D>& grid, Bodies<D>& bodies, Rocks<D>* rocks, double time) {
  bodies.hold_nodes(grid, time, true);
  sweep(grid, bodies, rocks, time, true);
}

/// Runs that other threads could take are worth it from so many points on.
constexpr std::size_t least_shared_points = 256;

template <int D>
void SurfaceContact<D>::order_runs(const Grid<D>& grid, const Bodies<D>& bodies, const Rocks<D>& rocks) {
  const std::size_t of_bodies = bodies.surface.size(), points = of_bodies + rocks.surface.size();
  if (workers_->count() == 1 || rocks.surface.empty() || points < least_shared_points) return;
  const auto at = [&](std::size_t k) -> const SurfacePoint<D>& {
    return k < of_bodies ? bodies.surface[k] : rocks.surface[k - of_bodies].soil;
  };
  const auto one = [&](std::size_t a, std::size_t b) {
    return (a < of_bodies) == (b < of_bodies) && at(a).owner == at(b).owner;
  };
  visited_by_.assign(grid.nodes.size(), -1);
  std::vector<Run> runs;
  std::vector<int> level, linked_to;  // by run: how many come before it in a row; the last one that comes after it
  std::vector<rvelab::WorkOrder::Pair> pairs;
  for (std::size_t first = 0; first < points; first = runs.back().last) {
    const int run = int(runs.size());
    runs.push_back({first, first});
    level.push_back(0);
    linked_to.push_back(-1);
    for (std::size_t& k = runs.back().last; k < points && one(first, k); ++k) {
      for (int j = 0; j < at(k).count; ++j) {
        const int before = std::exchange(visited_by_[std::size_t(at(k).node[j])], run);
        if (before < 0 || before == run || std::exchange(linked_to[std::size_t(before)], run) == run) continue;
        pairs.push_back({std::size_t(before), std::size_t(run)});
        level.back() = std::max(level.back(), level[std::size_t(before)] + 1);
      }
    }
  }
  std::vector<std::size_t> order(runs.size()), rank(runs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return level[a] < level[b]; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    runs_.push_back(runs[order[k]]);
    rank[order[k]] = k;
  }
  const std::size_t last = runs.size() - 1;
  for (auto& [before, after] : pairs) before = rank[before], after = rank[after];
  to_ = rvelab::WorkOrder(last + 1, pairs);
  for (auto& [before, after] : pairs) before = last - std::exchange(after, last - before);
  fro_ = rvelab::WorkOrder(last + 1, pairs);
}

/// Impulses that keep the soil from entering.
template <int D>
void SurfaceContact<D>::sweep(Grid<D>& grid, Bodies<D>& bodies, Rocks<D>* rocks, double time, bool end) {
  const std::size_t of_bodies = bodies.surface.size();
  const std::size_t points = of_bodies + (rocks != nullptr ? rocks->surface.size() : 0);
  each_surface_point(bodies, rocks, [](auto& point) { point.now.setZero(); });
  const bool of_rocks = rocks != nullptr && !rocks->soil.ghosts, pressed = end && of_rocks;
  const double begin = of_rocks ? wall_seconds() : 0;
  if (pressed) {
    each_run(points, false, [&](const Run& run) {
      for (std::size_t k = std::max(of_bodies, run.first); k < run.last; ++k) rocks->press(k - of_bodies, grid);
    });
    rocks->forget_pressed();
  }
  const int sweeps = std::max(bodies.sweeps, rocks != nullptr ? rocks->sweeps : 0);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const bool fro = sweep % 2 == 1;  // to and fro: sides alike
    each_run(points, fro, [&](const Run& run) {
      for (std::size_t n = run.first; n < run.last; ++n) {
        const std::size_t k = fro ? run.first + run.last - 1 - n : n;
        if (k < of_bodies)
          bodies.hold(bodies.surface[k], grid, time, end);
        else
          rocks->hold(k - of_bodies, grid, end);
      }
    });
    bodies.hold_plates(grid, end);
  }
  if (pressed) rocks->keep_pressed();
  each_surface_point(bodies, rocks, [&](auto& point) { (end ? point.at_end : point.at_start) += point.now; });
  if (of_rocks) rocks->soil_seconds += wall_seconds() - begin;
}

template class SurfaceContact<2>;
template class SurfaceContact<3>;

}  // namespace mpm
