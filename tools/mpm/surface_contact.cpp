// Contact at points of the surface of bodies. Declared in bodies.hpp.
#include <algorithm>
#include <cmath>

#include "tools/mpm/bodies.hpp"

namespace mpm {
namespace {

// Sweeps over the points of boxes and discs; what they leave is taken up in the steps that follow. On its way to the
// peak the load on a footing differs from that with 40 by 3 % with 5, by 1 % with 10 (Mohr-Coulomb soil).
constexpr int many_sweeps = 10;
constexpr double two_pi = 6.283185307179586;

}  // namespace

/// Adds a node to those that reach a point; false where there is no soil, or none of its own.
template <int D>
bool Bodies<D>::reaches(const Grid<D>& grid, const Planes<D>& planes, const typename Grid<D>::Index& node,
                        double weight, SurfacePoint& point) const {
  if (!(weight > 0)) return false;
  for (int i = 0; i < D; ++i) {
    if (node[i] < grid.low[i] || node[i] >= grid.low[i] + grid.count[i]) return false;
  }
  const long flat = grid.flat(node);
  if (!(grid.nodes[flat].mass > 0) || planes.is_behind(flat)) return false;
  point.node[point.count] = flat;
  point.weight[point.count++] = weight;
  return true;
}

/// A node of hardly any mass, which a point of the soil only just reaches, would take the impulse and leave the soil
/// where it is (a plate on an elastic block: 16 % of the stress lost). It goes with the body if it lies in it.
template <int D>
void Bodies<D>::keep(SurfacePoint& point, const Grid<D>& grid, double time) {
  constexpr double hardly = 0.1;
  int main = 0;
  for (int j = 1; j < point.count; ++j) main = point.weight[j] > point.weight[main] ? j : main;
  const double usual = grid.nodes[point.node[main]].mass / point.weight[main];
  double sum = 0;
  int kept = 0;
  for (int j = 0; j < point.count; ++j) {
    const long node = point.node[j];
    if (grid.nodes[node].mass < hardly * usual * point.weight[j]) {
      Vec<D> outward;
      const bool inside = all[point.body].distance(grid.position(grid.index(node)), time, outward) <= 0;
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

/// Over each node of the surface of a half-space across an axis; weights along that axis alone.
template <int D>
void Bodies<D>::find_half_space(const Grid<D>& grid, const Planes<D>& planes, int k, double time) {
  const auto& body = all[k];
  int axis = 0;
  body.normal.cwiseAbs().maxCoeff(&axis);
  const double surface = body.centre[axis] + body.velocity.way(time)[axis];
  const double per_m = 1 / grid.cell[axis], xi = (surface - grid.anchor[axis]) * per_m;
  double weight[3], slope[3];
  // GIMP carries a uniform stress to the edge of a point's domain as the linear functions do.
  const int base =
      shape_along_axis(shape == Shape::bspline ? Shape::bspline : Shape::linear, xi, per_m, 0, weight, slope);
  long places = 1;
  for (int i = 0; i < D; ++i) places *= i == axis ? 1 : grid.count[i];
  for (long place = 0; place < places; ++place) {
    auto node = grid.low;
    long rest = place;
    for (int i = 0; i < D; ++i) {
      if (i == axis) continue;
      node[i] += int(rest % grid.count[i]);
      rest /= grid.count[i];
    }
    SurfacePoint point;
    point.body = k;
    point.normal = body.normal;
    bool near = false;  // soil reaches a node at the surface or behind it
    for (int j = 0; j < 3; ++j) {
      node[axis] = base + j;
      if (!reaches(grid, planes, node, weight[j], point)) continue;
      near = near || (node[axis] - xi) * body.normal[axis] <= 1e-6;
    }
    if (near) keep(point, grid, time);
  }
}

/// A point of a box or disc (m), with the normal into the soil.
template <int D>
void Bodies<D>::add_point(const Grid<D>& grid, const Planes<D>& planes, int k, double time, const Vec<D>& at,
                          const Vec<D>& normal) {
  double weight[D][3], slope[3];
  typename Grid<D>::Index base, nearest;
  for (int i = 0; i < D; ++i) {
    const double per_m = 1 / grid.cell[i], xi = (at[i] - grid.anchor[i]) * per_m;
    base[i] =
        shape_along_axis(shape == Shape::bspline ? Shape::bspline : Shape::linear, xi, per_m, 0, weight[i], slope);
    nearest[i] = int(floor_of(xi + 0.5));
    if (nearest[i] < grid.low[i] || nearest[i] >= grid.low[i] + grid.count[i]) return;
  }
  if (planes.is_behind(grid.flat(nearest))) return;
  SurfacePoint point;
  point.body = k;
  point.normal = normal;
  bool near = false;
  const double touch = 1e-6 * grid.cell.minCoeff();
  for (int n = 0; n < reach; ++n) {
    const int j[3] = {n % 3, n / 3 % 3, n / 9};
    auto node = base;
    double product = 1;
    for (int i = 0; i < D; ++i) {
      node[i] += j[i];
      product *= weight[i][j[i]];
    }
    if (!reaches(grid, planes, node, product, point)) continue;
    Vec<D> outward;
    near = near || all[k].distance(grid.position(node), time, outward) <= touch;
  }
  if (near) keep(point, grid, time);
}

/// Points a cell apart: on the faces of a box in the middle of equal parts, on a disc from the x-axis on.
template <int D>
void Bodies<D>::find_outline(const Grid<D>& grid, const Planes<D>& planes, int k, double time) {
  const auto& body = all[k];
  const Vec<D> centre = body.centre + body.velocity.way(time);
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
    for (auto& point : surface_) {
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

template void Bodies<2>::find_half_space(const Grid<2>&, const Planes<2>&, int, double);
template void Bodies<2>::find_outline(const Grid<2>&, const Planes<2>&, int, double);
template void Bodies<2>::hold_surface(Grid<2>&, double, bool);
template void Bodies<3>::find_half_space(const Grid<3>&, const Planes<3>&, int, double);
template void Bodies<3>::find_outline(const Grid<3>&, const Planes<3>&, int, double);
template void Bodies<3>::hold_surface(Grid<3>&, double, bool);

}  // namespace mpm
