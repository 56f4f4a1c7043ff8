// Contact at points of the surface of bodies. Declared in bodies.hpp.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

#include "tools/mpm/bodies.hpp"
#include "tools/mpm/clock.hpp"
#include "tools/mpm/rocks.hpp"
#include "tools/mpm/touching.hpp"

namespace mpm {
namespace {

// Sweeps over points that share nodes; the steps that follow correct what they leave. Before the peak the load on a
// footing differs from that with 40 sweeps by 3 % with 5, by 1 % with 10 (Mohr-Coulomb soil).
constexpr int many_sweeps = 10;
/// The faces of a body that a point of the soil touches, and the node nearest to the contact; no bits: none. A point
/// touches where its domain, of its first form and the size that its volume tells, ends at the surface.
template <int D, class Outline>
unsigned char faces_touched(const Grid<D>& grid, const Outline& outline, const Vec<D>& centre, const Point<D>& point,
                            typename Grid<D>::Index& node) {
  const double slack = early * grid.cell.minCoeff();
  Vec<D> outward;
  const Vec<D> r = point.position - centre;
  const double distance = outline.distance(r, outward, point.half);
  if (distance > slack + 0.5 * grid.cell.sum()) return 0;  // the roots below are for few points
  const Vec<D> half = half_size<D>(point);
  if (distance > slack + half.cwiseProduct(outward).norm()) return 0;
  const Vec<D> foot = r - distance * outward;
  if (!outline.spans(foot, half)) return 0;
  return nearest_node<D>(grid, centre + foot, node) ? outline.face_of(outward) : 0;
}

}  // namespace

/// Threads set bits of one node together: their order does not matter.
template <int D>
template <class Outline>
void Bodies<D>::detect_soil(const Grid<D>& grid, const Outline& outline, const Vec<D>& centre,
                            const std::vector<Point<D>>& soil, Workers& workers) {
  soil_at_.assign(grid.nodes.size(), 0);
  const long n = long(soil.size());
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    for (long p = long(piece) * chunk; p < std::min(n, long(piece + 1) * chunk); ++p) {
      typename Grid<D>::Index node;
      const auto faces = faces_touched<D>(grid, outline, centre, soil[p], node);
      if (faces != 0) std::atomic_ref(soil_at_[grid.flat(node)]).fetch_or(faces, std::memory_order_relaxed);
    }
  });
}

template <int D>
void Bodies<D>::detect_surface(const Grid<D>& grid, const Planes<D>& planes, const std::vector<Point<D>>& soil, int k,
                               double time, Workers& workers) {
  const Vec<D> centre = all[k].centre_at(time);
  const auto detect = [&](const auto& outline) {
    detect_soil(grid, outline, centre, soil, workers);
    const int axis = outline.column_axis();
    if (axis < 0) sweeps_ = many_sweeps;
    outline.each_surface_point(grid, centre, [&](const Vec<D>& at, const Vec<D>& normal) {
      SurfacePoint point;
      point.body = k;
      point.normal = normal;
      if (axis < 0)
        hold_point(grid, planes, point, time, at, outline.face_of(normal));
      else
        hold_in_column(grid, planes, point, time, at, outline.face_of(normal), axis);
    });
  };
  std::visit(detect, all[k].shape);
}

/// Whether soil touches that face within a cell of the node along each axis.
template <int D>
bool Bodies<D>::has_soil_near(const Grid<D>& grid, const typename Grid<D>::Index& node, unsigned char face) const {
  for (int n = 0; n < reach; ++n) {
    const int step[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    auto beside = node;
    for (int i = 0; i < D; ++i) beside[i] += step[i];
    if (grid.contains(beside) && (soil_at_[grid.flat(beside)] & face) != 0) return true;
  }
  return false;
}

/// Adds a node to those that reach a point of the surface, if it has soil of its own and is no mirror node.
template <int D>
void Bodies<D>::add_node(const Grid<D>& grid, const Planes<D>& planes, const typename Grid<D>::Index& node,
                         double weight, SurfacePoint& point) {
  if (!(weight > 0) || !grid.contains(node)) return;
  const long flat = grid.flat(node);
  if (!(grid.nodes[flat].mass > 0) || planes.is_mirror(flat)) return;
  point.node[point.count] = flat;
  point.weight[point.count++] = weight;
}

/// Completes a point of the surface; false: no node with soil reaches it. Of rocks it changes the point alone, so that
/// threads may call it. A node of little mass, which the soil only just
/// reaches, would take the impulse and leave the soil where it is (a plate on an elastic block: 16 % of the stress
/// lost): it is left out, and moves with a prescribed body or a plate if it lies in it: alone, a node outside of the
/// soil has forces that fall more slowly than its mass, and grows unstable. In rocks that cost a ball of points another
/// 4 % of its speed.
template <int D>
bool Bodies<D>::hold(SurfacePoint& point, const Grid<D>& grid, double time) {
  if (point.count == 0) return false;
  constexpr double little = 0.1;  // of the mass per weight at the node of most weight
  const int most = int(std::max_element(point.weight, point.weight + point.count) - point.weight);
  const double usual = grid.nodes[point.node[most]].mass / point.weight[most];
  const bool of_rock = point.body >= int(all.size());
  const Vec<D> centre = of_rock ? Vec<D>(Vec<D>::Zero()) : all[point.body].centre_at(time);
  double sum = 0;
  int kept = 0;
  for (int j = 0; j < point.count; ++j) {
    const long node = point.node[j];
    if (grid.nodes[node].mass < little * usual * point.weight[j]) {
      if (of_rock) continue;
      Vec<D> outward;
      const bool inside = all[point.body].distance(grid.position(grid.index(node)) - centre, outward) <= 0;
      if (inside) contacts_.push_back({node, point.body, point.normal, Vec<D>::Zero(), Vec<D>::Zero()});
      continue;
    }
    point.node[kept] = node;
    point.weight[kept++] = point.weight[j];
    sum += point.weight[j];
  }
  point.count = kept;
  for (int j = 0; j < point.count; ++j) {
    point.weight[j] /= sum;
    point.mobility += point.weight[j] * point.weight[j] / grid.nodes[point.node[j]].mass;
  }
  return true;
}

/// Weights at a point of a surface along one axis. GIMP carries a uniform stress to the edge of a point's domain as the
/// linear functions do.
template <int D>
int Bodies<D>::surface_weights(double xi, double* weight) const {
  if (shape != Shape::bspline) return hats_along_axis(xi, weight);
  double slope[3];
  return shape_along_axis(Shape::bspline, xi, 1, 0, weight, slope);
}

template <int D>
void Bodies<D>::hold_point(const Grid<D>& grid, const Planes<D>& planes, SurfacePoint& point, double time,
                           const Vec<D>& at, unsigned char face) {
  typename Grid<D>::Index nearest;
  if (!nearest_node(grid, at, nearest) || planes.is_mirror(grid.flat(nearest)) || !has_soil_near(grid, nearest, face)) {
    return;
  }
  if (hold_at(grid, planes, point, time, at)) surface_.push_back(point);
}

/// By the nodes that reach a place, which is in the box of the grid.
template <int D>
bool Bodies<D>::hold_at(const Grid<D>& grid, const Planes<D>& planes, SurfacePoint& point, double time,
                        const Vec<D>& at) {
  typename Grid<D>::Index base;
  double weight[D][3];
  for (int i = 0; i < D; ++i) base[i] = surface_weights((at[i] - grid.anchor[i]) / grid.cell[i], weight[i]);
  for (int n = 0; n < reach; ++n) {
    const int j[3] = {n % 3, n / 3 % 3, n / 9};
    auto node = base;
    double product = 1;
    for (int i = 0; i < D; ++i) {
      node[i] += j[i];
      product *= weight[i][j[i]];
    }
    add_node(grid, planes, node, product, point);
  }
  return hold(point, grid, time);
}

/// A point whose nodes lie in one column along an axis.
template <int D>
void Bodies<D>::hold_in_column(const Grid<D>& grid, const Planes<D>& planes, SurfacePoint& point, double time,
                               const Vec<D>& at, unsigned char face, int axis) {
  const double xi = (at[axis] - grid.anchor[axis]) / grid.cell[axis];
  if (!(xi > grid.low[axis] - 2 && xi < grid.low[axis] + grid.count[axis] + 1)) return;  // no soil is there
  auto node = rounded(grid, at);
  if (!has_soil_near(grid, node, face)) return;
  double weight[3];
  const int base = surface_weights(xi, weight);
  for (int j = 0; j < 3; ++j) {
    node[axis] = base + j;
    add_node(grid, planes, node, weight[j], point);
  }
  if (hold(point, grid, time)) surface_.push_back(point);
}

/// m/s, of the soil.
template <int D>
Vec<D> Bodies<D>::velocity_at(const Grid<D>& grid, const SurfacePoint& point, bool end) const {
  Vec<D> sum = Vec<D>::Zero();
  for (int j = 0; j < point.count; ++j) {
    const auto& node = grid.nodes[point.node[j]];
    for (int i = 0; i < D; ++i) sum[i] += point.weight[j] * (end ? node.w : node.v)[i];
  }
  return sum;
}

template <int D>
void Bodies<D>::push(Grid<D>& grid, SurfacePoint& point, const Vec<D>& impulse, bool end) const {
  for (int j = 0; j < point.count; ++j) {
    auto& node = grid.nodes[point.node[j]];
    for (int i = 0; i < D; ++i) (end ? node.w : node.v)[i] += point.weight[j] / node.mass * impulse[i];
  }
}

template <int D>
Vec<D> Bodies<D>::along_surface(const Body<D>& body, const SurfacePoint& point, const Vec<D>& wanted, double across) {
  if (!(across > 0)) return Vec<D>::Zero();
  Vec<D> along = wanted - wanted.dot(point.normal) * point.normal;
  const double most = body.friction * across, size = along.norm();
  if (!body.rough && size > most) along *= most / size;
  return along;
}

/// Runs that other threads could take are worth it from so many points on.
constexpr std::size_t least_shared_points = 256;

template <int D>
void Bodies<D>::order_runs(const Grid<D>& grid) {
  if (workers_->count() == 1 || rocks->surface.empty() || surface_.size() < least_shared_points) return;
  visited_by_.assign(grid.nodes.size(), -1);
  std::vector<Run> runs;
  std::vector<int> level, linked_to;  // by run: how many come before it in a row; the last one that comes after it
  std::vector<WorkOrder::Pair> pairs;
  for (std::size_t first = 0; first < surface_.size(); first = runs.back().last) {
    const int run = int(runs.size());
    runs.push_back({first, first});
    level.push_back(0);
    linked_to.push_back(-1);
    for (std::size_t& k = runs.back().last; k < surface_.size() && surface_[k].body == surface_[first].body; ++k) {
      for (int j = 0; j < surface_[k].count; ++j) {
        const int before = std::exchange(visited_by_[std::size_t(surface_[k].node[j])], run);
        if (before < 0 || before == run || std::exchange(linked_to[std::size_t(before)], run) == run) continue;
        pairs.push_back({before, run});
        level.back() = std::max(level.back(), level[std::size_t(before)] + 1);
      }
    }
  }
  std::vector<std::int64_t> order(runs.size()), place(runs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return level[std::size_t(a)] < level[std::size_t(b)]; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    runs_.push_back(runs[std::size_t(order[k])]);
    place[std::size_t(order[k])] = std::int64_t(k);
  }
  const std::int64_t last = std::int64_t(runs.size()) - 1;
  for (auto& [before, after] : pairs) before = place[std::size_t(before)], after = place[std::size_t(after)];
  to_ = WorkOrder(last + 1, pairs);
  for (auto& [before, after] : pairs) before = last - std::exchange(after, last - before);
  fro_ = WorkOrder(last + 1, pairs);
}

/// Sweeps one point: its impulse, with those at the others as they are now.
template <int D>
void Bodies<D>::hold_here(std::size_t k, Grid<D>& grid, double time, bool end) {
  auto& point = surface_[k];
  if (point.body >= int(all.size())) return hold_rock(k, grid, end);
  const auto& body = all[point.body];
  if (body.pressed()) return;
  const Vec<D> relative = velocity_at(grid, point, end) - body.velocity.at(time);
  const Vec<D> wanted = point.now - relative / point.mobility;
  const double across = std::max(0.0, wanted.dot(point.normal));
  const Vec<D> more = across * point.normal + along_surface(body, point, wanted, across) - point.now;
  if (more.isZero(0)) return;
  point.now += more;
  push(grid, point, more, end);
}

/// Impulses that keep the soil from entering: across the surface they only push, along it they act up to friction.
template <int D>
void Bodies<D>::hold_surface(Grid<D>& grid, double time, bool end) {
  for (auto& point : surface_) point.now.setZero();
  const bool of_rocks = rocks != nullptr && !rocks->soil.ghosts, pressed = end && of_rocks;
  const double begin = of_rocks ? wall_seconds() : 0;
  if (pressed) press_rocks(grid);
  for (int sweep = 0; sweep < sweeps_; ++sweep) {
    const bool fro = sweep % 2 == 1;  // to and fro: sides alike
    each_run(fro, [&](const Run& run) {
      for (std::size_t k = run.first; k < run.last; ++k)
        hold_here(fro ? run.first + run.last - 1 - k : k, grid, time, end);
    });
    for (auto& body : all) {
      if (body.pressed()) hold_plate(body, grid, end);
    }
  }
  if (pressed) keep_pressed();
  for (auto& point : surface_) (end ? point.at_end : point.at_start) += point.now;
  if (of_rocks) rocks->soil_seconds += wall_seconds() - begin;
}

template void Bodies<2>::order_runs(const Grid<2>&);
template void Bodies<3>::order_runs(const Grid<3>&);
template void Bodies<2>::detect_surface(const Grid<2>&, const Planes<2>&, const std::vector<Point<2>>&, int, double,
                                        Workers&);
template void Bodies<2>::hold_surface(Grid<2>&, double, bool);
template void Bodies<3>::detect_surface(const Grid<3>&, const Planes<3>&, const std::vector<Point<3>>&, int, double,
                                        Workers&);
template void Bodies<3>::hold_surface(Grid<3>&, double, bool);
template Vec<2> Bodies<2>::velocity_at(const Grid<2>&, const SurfacePoint&, bool) const;
template Vec<3> Bodies<3>::velocity_at(const Grid<3>&, const SurfacePoint&, bool) const;
template Vec<2> Bodies<2>::along_surface(const Body<2>&, const SurfacePoint&, const Vec<2>&, double);
template Vec<3> Bodies<3>::along_surface(const Body<3>&, const SurfacePoint&, const Vec<3>&, double);
template void Bodies<2>::push(Grid<2>&, SurfacePoint&, const Vec<2>&, bool) const;
template void Bodies<3>::push(Grid<3>&, SurfacePoint&, const Vec<3>&, bool) const;
template bool Bodies<2>::hold_at(const Grid<2>&, const Planes<2>&, SurfacePoint&, double, const Vec<2>&);
template bool Bodies<3>::hold_at(const Grid<3>&, const Planes<3>&, SurfacePoint&, double, const Vec<3>&);

}  // namespace mpm
