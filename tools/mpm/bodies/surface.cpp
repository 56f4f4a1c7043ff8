// Contact at points of the surface of bodies. Declared in bodies.hpp.
#include <algorithm>
#include <atomic>

#include "tools/mpm/bodies/bodies.hpp"
#include "tools/mpm/bodies/touching.hpp"

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
                            const std::vector<Point<D>>& soil, rvelab::Workers& workers) {
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
                               double time, rvelab::Workers& workers) {
  const Vec<D> centre = all[k].centre_at(time);
  const auto detect = [&](const auto& outline) {
    detect_soil(grid, outline, centre, soil, workers);
    const int axis = outline.column_axis();
    if (axis < 0) sweeps = many_sweeps;
    outline.each_surface_point(grid, centre, [&](const Vec<D>& at, const Vec<D>& normal) {
      SurfacePoint<D> point;
      point.owner = k;
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
  for (int n = 0; n < SurfacePoint<D>::reach; ++n) {
    const int step[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    auto beside = node;
    for (int i = 0; i < D; ++i) beside[i] += step[i];
    if (grid.contains(beside) && (soil_at_[grid.flat(beside)] & face) != 0) return true;
  }
  return false;
}

/// A light node moves with the body if it lies in it: alone, a node outside of the soil has forces that fall more
/// slowly than its mass, and grows unstable.
template <int D>
void Bodies<D>::keep(SurfacePoint<D>& point, const Grid<D>& grid, double time) {
  const Vec<D> centre = all[point.owner].centre_at(time);
  const bool held = point.complete(grid, [&](long node) {
    Vec<D> outward;
    const bool inside = all[point.owner].distance(grid.position(grid.index(node)) - centre, outward) <= 0;
    if (inside) contacts_.push_back({node, point.owner, point.normal, Vec<D>::Zero(), Vec<D>::Zero()});
  });
  if (held) surface.push_back(point);
}

template <int D>
void Bodies<D>::hold_point(const Grid<D>& grid, const Planes<D>& planes, SurfacePoint<D>& point, double time,
                           const Vec<D>& at, unsigned char face) {
  typename Grid<D>::Index nearest;
  if (!nearest_node(grid, at, nearest) || planes.is_mirror(grid.flat(nearest)) || !has_soil_near(grid, nearest, face)) {
    return;
  }
  point.add_nodes(grid, planes, shape, at);
  keep(point, grid, time);
}

/// A point whose nodes lie in one column along an axis.
template <int D>
void Bodies<D>::hold_in_column(const Grid<D>& grid, const Planes<D>& planes, SurfacePoint<D>& point, double time,
                               const Vec<D>& at, unsigned char face, int axis) {
  const double xi = (at[axis] - grid.anchor[axis]) / grid.cell[axis];
  if (!(xi > grid.low[axis] - 2 && xi < grid.low[axis] + grid.count[axis] + 1)) return;  // no soil is there
  auto node = rounded(grid, at);
  if (!has_soil_near(grid, node, face)) return;
  double weight[3];
  const int base = SurfacePoint<D>::surface_weights(shape, xi, weight);
  for (int j = 0; j < 3; ++j) {
    node[axis] = base + j;
    point.add_node(grid, planes, node, weight[j]);
  }
  keep(point, grid, time);
}

template <int D>
Vec<D> Bodies<D>::along_surface(const Body<D>& body, const SurfacePoint<D>& point, const Vec<D>& wanted,
                                double across) {
  if (!(across > 0)) return Vec<D>::Zero();
  Vec<D> along = wanted - wanted.dot(point.normal) * point.normal;
  const double most = body.friction * across, size = along.norm();
  if (!body.rough && size > most) along *= most / size;
  return along;
}

/// Across the surface impulses only push, along it they act up to friction.
template <int D>
void Bodies<D>::hold(SurfacePoint<D>& point, Grid<D>& grid, double time, bool end) const {
  const auto& body = all[point.owner];
  if (body.pressed()) return;
  const Vec<D> relative = point.velocity(grid, end) - body.velocity.at(time);
  const Vec<D> wanted = point.now - relative / point.mobility;
  const double across = std::max(0.0, wanted.dot(point.normal));
  const Vec<D> more = across * point.normal + along_surface(body, point, wanted, across) - point.now;
  if (more.isZero(0)) return;
  point.now += more;
  point.push(grid, more, end);
}

#define MPM_INSTANTIATE(D)                                                                                             \
  template void Bodies<D>::detect_surface(const Grid<D>&, const Planes<D>&, const std::vector<Point<D>>&, int, double, \
                                          rvelab::Workers&);                                                           \
  template void Bodies<D>::hold(SurfacePoint<D>&, Grid<D>&, double, bool) const;                                       \
  template Vec<D> Bodies<D>::along_surface(const Body<D>&, const SurfacePoint<D>&, const Vec<D>&, double);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
