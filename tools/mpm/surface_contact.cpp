// Contact at points of the surface of bodies. Declared in bodies.hpp.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "tools/mpm/bodies.hpp"

namespace mpm {
namespace {

// Sweeps over points that share nodes; what they leave is taken up in the steps that follow. On its way to the
// peak the load on a footing differs from that with 40 by 3 % with 5, by 1 % with 10 (Mohr-Coulomb soil).
constexpr int many_sweeps = 10;
// Cells by which soil is met before its domain ends at the surface: what strain moves a point by against its domain.
constexpr double early = 0.1;
constexpr double two_pi = 6.283185307179586;

}  // namespace

/// A point of the soil touches where its domain, of its first form and the size that its volume tells, ends at the
/// surface. The faces of a box are told apart: soil below it, or off its corner, is not beside it.
template <int D>
unsigned char Bodies<D>::touch_of(const Grid<D>& grid, const Body<D>& body, const Vec<D>& centre, const Point<D>& point,
                                  typename Grid<D>::Index& node) const {
  const double slack = early * grid.cell.minCoeff();
  Vec<D> outward;
  const Vec<D> r = point.position - centre;
  const double distance = body.distance(r, outward, point.half);
  if (distance > slack + 0.5 * grid.cell.sum()) return 0;  // the roots below are for few points
  const double swollen = D == 2 ? std::sqrt(point.F.determinant()) : std::cbrt(point.F.determinant());
  const Vec<D> half = swollen * point.half;
  if (distance > slack + half.cwiseProduct(outward).norm()) return 0;
  const Vec<D> foot = r - distance * outward;
  if (body.kind == BodyKind::box) {
    for (int i = 0; i < D; ++i) {  // off by half of it, or so far that a small body would slip between two points
      const double at_most = std::max(0.5 * half[i], half[i] - (1 - 1e-6) * body.half[i]);
      if (std::abs(foot[i]) - body.half[i] > at_most) return 0;
    }
  }
  return nearest_node(grid, centre + foot, node) ? face_of(body, outward) : 0;
}

/// Which nodes have soil against the surface near them. Threads set bits of one node together, whose order is nothing.
template <int D>
void Bodies<D>::find_touched(const Grid<D>& grid, const std::vector<Point<D>>& soil, int k, double time,
                             Workers& workers) {
  touched_.assign(grid.nodes.size(), 0);
  const Vec<D> centre = all[k].centre_at(time);
  const long n = long(soil.size());
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    for (long p = long(piece) * chunk; p < std::min(n, long(piece + 1) * chunk); ++p) {
      typename Grid<D>::Index node;
      const auto bits = touch_of(grid, all[k], centre, soil[p], node);
      if (bits != 0) std::atomic_ref(touched_[grid.flat(node)]).fetch_or(bits, std::memory_order_relaxed);
    }
  });
}

template <int D>
bool Bodies<D>::nearest_node(const Grid<D>& grid, const Vec<D>& at, typename Grid<D>::Index& node) {
  for (int i = 0; i < D; ++i) {
    const double xi = (at[i] - grid.anchor[i]) / grid.cell[i] + 0.5;
    if (!(xi >= grid.low[i] && xi < grid.low[i] + grid.count[i])) return false;
    node[i] = int(floor_of(xi));
  }
  return true;
}

/// One bit for each face of a box; one for all of another body.
template <int D>
unsigned char Bodies<D>::face_of(const Body<D>& body, const Vec<D>& normal) {
  if (body.kind != BodyKind::box) return 1;
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return static_cast<unsigned char>(1 << (2 * axis + (normal[axis] > 0)));
}

/// Whether soil is against the surface within a cell of the node along each axis.
template <int D>
bool Bodies<D>::is_touched(const Grid<D>& grid, const typename Grid<D>::Index& node, unsigned char face) const {
  for (int n = 0; n < reach; ++n) {
    const int step[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    auto beside = node;
    bool inside = true;
    for (int i = 0; i < D; ++i) {
      beside[i] += step[i];
      inside = inside && beside[i] >= grid.low[i] && beside[i] < grid.low[i] + grid.count[i];
    }
    if (inside && (touched_[grid.flat(beside)] & face) != 0) return true;
  }
  return false;
}

/// Adds a node to those that reach a point of the surface, if it has soil of its own (not mirrored by a plane).
template <int D>
void Bodies<D>::add_node(const Grid<D>& grid, const Planes<D>& planes, const typename Grid<D>::Index& node,
                         double weight, SurfacePoint& point) {
  if (!(weight > 0)) return;
  for (int i = 0; i < D; ++i) {
    if (node[i] < grid.low[i] || node[i] >= grid.low[i] + grid.count[i]) return;
  }
  const long flat = grid.flat(node);
  if (!(grid.nodes[flat].mass > 0) || planes.is_behind(flat)) return;
  point.node[point.count] = flat;
  point.weight[point.count++] = weight;
}

/// Takes a point of the surface into those that are held. A node of little mass, which the soil only just reaches,
/// would take the impulse and leave the soil where it is (a plate on an elastic block: 16 % of the stress lost): it is
/// left out, and goes with the body if it lies in it.
template <int D>
void Bodies<D>::hold(SurfacePoint& point, const Grid<D>& grid, double time) {
  if (point.count == 0) return;
  constexpr double little = 0.1;  // of the mass per weight at the node of most weight
  const int most = int(std::max_element(point.weight, point.weight + point.count) - point.weight);
  const double usual = grid.nodes[point.node[most]].mass / point.weight[most];
  const Vec<D> centre = all[point.body].centre_at(time);
  double sum = 0;
  int kept = 0;
  for (int j = 0; j < point.count; ++j) {
    const long node = point.node[j];
    if (grid.nodes[node].mass < little * usual * point.weight[j]) {
      Vec<D> outward;
      const bool inside = all[point.body].distance(grid.position(grid.index(node)) - centre, outward) <= 0;
      if (inside) contacts_.push_back({node, point.body, point.normal, Vec<D>::Zero()});
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
  point.impulse.setZero();
  surface_.push_back(point);
}

/// Weights at a point of a surface along one axis. GIMP carries a uniform stress to the edge of a point's domain as the
/// linear functions do.
template <int D>
int Bodies<D>::surface_weights(double xi, double* weight) const {
  double slope[3];
  return shape_along_axis(shape == Shape::bspline ? Shape::bspline : Shape::linear, xi, 1, 0, weight, slope);
}

/// A point of a surface (m), with the normal into the soil.
template <int D>
void Bodies<D>::add_point(const Grid<D>& grid, const Planes<D>& planes, int k, double time, const Vec<D>& at,
                          const Vec<D>& normal) {
  typename Grid<D>::Index base, nearest;
  if (!nearest_node(grid, at, nearest) || planes.is_behind(grid.flat(nearest)) ||
      !is_touched(grid, nearest, face_of(all[k], normal))) {
    return;
  }
  double weight[D][3];
  for (int i = 0; i < D; ++i) base[i] = surface_weights((at[i] - grid.anchor[i]) / grid.cell[i], weight[i]);
  SurfacePoint point;
  point.body = k;
  point.normal = normal;
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
  hold(point, grid, time);
}

/// Where columns of nodes come through the surface of a half-space, along the axis that brings them closest together;
/// across an axis with weights along that axis alone.
template <int D>
void Bodies<D>::find_half_space(const Grid<D>& grid, const Planes<D>& planes, int k, double time) {
  const auto& body = all[k];
  const Vec<D> centre = body.centre_at(time);
  const bool across_axis = body.normal.cwiseAbs().maxCoeff() == body.normal.cwiseAbs().sum();
  int axis = 0;
  body.normal.cwiseProduct(grid.cell).cwiseAbs().maxCoeff(&axis);
  if (!across_axis) sweeps_ = many_sweeps;
  long columns = 1;
  for (int i = 0; i < D; ++i) columns *= i == axis ? 1 : grid.count[i];
  for (long column = 0; column < columns; ++column) {
    auto node = grid.low;
    long rest = column;
    for (int i = 0; i < D; ++i) {
      if (i == axis) continue;
      node[i] += int(rest % grid.count[i]);
      rest /= grid.count[i];
    }
    Vec<D> at = grid.position(node);
    at[axis] = centre[axis];
    for (int i = 0; i < D; ++i) {
      if (i != axis) at[axis] -= body.normal[i] * (at[i] - centre[i]) / body.normal[axis];
    }
    if (!across_axis) {
      add_point(grid, planes, k, time, at, body.normal);
      continue;
    }
    const double xi = (at[axis] - grid.anchor[axis]) / grid.cell[axis];
    if (!(xi > grid.low[axis] - 2 && xi < grid.low[axis] + grid.count[axis] + 1)) return;  // no soil is there
    node[axis] = int(floor_of(xi + 0.5));
    if (!is_touched(grid, node, face_of(body, body.normal))) continue;
    SurfacePoint point;
    point.body = k;
    point.normal = body.normal;
    double weight[3];
    const int base = surface_weights(xi, weight);
    for (int j = 0; j < 3; ++j) {
      node[axis] = base + j;
      add_node(grid, planes, node, weight[j], point);
    }
    hold(point, grid, time);
  }
}

/// Points a cell apart: on the faces of a box in the middle of equal parts, on a disc from the x-axis on.
template <int D>
void Bodies<D>::find_outline(const Grid<D>& grid, const Planes<D>& planes, int k, double time) {
  const auto& body = all[k];
  const Vec<D> centre = body.centre_at(time);
  sweeps_ = many_sweeps;
  if (body.kind == BodyKind::disc) {
    const long around = std::max(8L, std::lround(two_pi * body.radius / grid.cell.template head<2>().minCoeff()));
    const long layers = D == 3 ? grid.count[D - 1] : 1;
    for (long layer = 0; layer < layers; ++layer) {
      for (long n = 0; n < around; ++n) {
        const double angle = two_pi * double(n) / double(around);
        Vec<D> normal = Vec<D>::Zero();
        normal[0] = std::cos(angle);
        normal[1] = std::sin(angle);
        Vec<D> at = centre + body.radius * normal;
        if (D == 3) at[D - 1] = grid.anchor[D - 1] + (grid.low[D - 1] + double(layer)) * grid.cell[D - 1];
        add_point(grid, planes, k, time, at, normal);
      }
    }
    return;
  }
  for (int axis = 0; axis < D; ++axis) {
    long parts[3] = {1, 1, 1}, total = 1;
    for (int i = 0; i < D; ++i) {
      if (i != axis) parts[i] = std::max(1L, std::lround(2 * body.half[i] / grid.cell[i]));
      total *= parts[i];
    }
    for (const int side : {-1, 1}) {
      for (long n = 0; n < total; ++n) {
        Vec<D> at = centre, normal = Vec<D>::Zero();
        normal[axis] = side;
        long rest = n;
        for (int i = 0; i < D; ++i) {
          if (i == axis) continue;
          at[i] += body.half[i] * ((2 * double(rest % parts[i]) + 1) / double(parts[i]) - 1);
          rest /= parts[i];
        }
        at[axis] += side * body.half[axis];
        add_point(grid, planes, k, time, at, normal);
      }
    }
  }
}

/// Impulses that keep the soil from entering: across the surface they push alone, along it up to friction.
template <int D>
void Bodies<D>::hold_surface(Grid<D>& grid, double time, bool end) {
  for (auto& point : surface_) point.now.setZero();
  for (int sweep = 0; sweep < sweeps_; ++sweep) {
    for (std::size_t k = 0; k < surface_.size(); ++k) {
      auto& point = surface_[sweep % 2 == 0 ? k : surface_.size() - 1 - k];  // to and fro: sides alike
      const auto& body = all[point.body];
      Vec<D> relative = -body.velocity.at(time);
      for (int j = 0; j < point.count; ++j) {
        const auto& node = grid.nodes[point.node[j]];
        for (int i = 0; i < D; ++i) relative[i] += point.weight[j] * (end ? node.w : node.v)[i];
      }
      const Vec<D> wanted = point.now - relative / point.mobility;
      const double across = std::max(0.0, wanted.dot(point.normal));
      Vec<D> along = Vec<D>::Zero();
      if (across > 0) {
        along = wanted - wanted.dot(point.normal) * point.normal;
        const double most = body.friction * across, size = along.norm();
        if (!body.rough && size > most) along *= most / size;
      }
      const Vec<D> more = across * point.normal + along - point.now;
      if (more.isZero(0)) continue;
      point.now += more;
      for (int j = 0; j < point.count; ++j) {
        auto& node = grid.nodes[point.node[j]];
        for (int i = 0; i < D; ++i) (end ? node.w : node.v)[i] += point.weight[j] / node.mass * more[i];
      }
    }
  }
  for (auto& point : surface_) point.impulse += point.now;
}

template void Bodies<2>::find_touched(const Grid<2>&, const std::vector<Point<2>>&, int, double, Workers&);
template void Bodies<2>::find_half_space(const Grid<2>&, const Planes<2>&, int, double);
template void Bodies<2>::find_outline(const Grid<2>&, const Planes<2>&, int, double);
template void Bodies<2>::hold_surface(Grid<2>&, double, bool);
template void Bodies<3>::find_touched(const Grid<3>&, const std::vector<Point<3>>&, int, double, Workers&);
template void Bodies<3>::find_half_space(const Grid<3>&, const Planes<3>&, int, double);
template void Bodies<3>::find_outline(const Grid<3>&, const Planes<3>&, int, double);
template void Bodies<3>::hold_surface(Grid<3>&, double, bool);

}  // namespace mpm
