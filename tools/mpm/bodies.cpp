#include "tools/mpm/bodies.hpp"

#include <algorithm>

namespace mpm {

template <int D>
double Body<D>::distance(const Vec<D>& position, double time, Vec<D>& outward) const {
  const Vec<D> r = position - centre - velocity.way(time);
  if (kind == BodyKind::half_space) {
    outward = normal;
    return r.dot(normal);
  }
  if (kind == BodyKind::disc) {
    outward = r;
    if (D == 3) outward[D - 1] = 0;
    const double length = outward.norm();
    if (length > 0) outward /= length;
    return length - radius;
  }
  // The nearest face; of two at one distance that across the last axis, a footing's lower one.
  double nearest = -1e300;
  outward.setZero();
  for (int i = 0; i < D; ++i) {
    const double beyond = std::abs(r[i]) - half[i];
    if (beyond < nearest - 1e-9 * half[i]) continue;
    nearest = beyond;
    outward.setZero();
    outward[i] = r[i] < 0 ? -1 : 1;
  }
  return nearest;
}

template <int D>
void Bodies<D>::find(const Grid<D>& grid, const Planes<D>& planes, double time) {
  contacts_.clear();
  surface_.clear();
  bool at_nodes = false;
  for (int k = 0; k < int(all.size()); ++k) {
    if (all[k].at_surface) {
      find_surface(grid, planes, k, time);
    } else {
      at_nodes = true;
    }
  }
  if (!at_nodes) return;
  const double touch = 1e-6 * grid.cell.minCoeff();
  for (long flat = 0; flat < long(grid.nodes.size()); ++flat) {
    if (!(grid.nodes[flat].mass > 0) || planes.is_behind(flat)) continue;
    const Vec<D> x = grid.position(grid.index(flat));
    for (int k = 0; k < int(all.size()); ++k) {
      Vec<D> outward;
      if (all[k].at_surface || all[k].distance(x, time, outward) > touch) continue;
      contacts_.push_back({flat, k, outward, Vec<D>::Zero()});
    }
  }
}

template <int D>
void Bodies<D>::find_surface(const Grid<D>& grid, const Planes<D>& planes, int k, double time) {
  const auto& body = all[k];
  int axis = 0;
  body.normal.cwiseAbs().maxCoeff(&axis);
  const double surface = body.centre[axis] + body.velocity.way(time)[axis];
  const double per_m = 1 / grid.cell[axis], xi = (surface - grid.anchor[axis]) * per_m;
  double weight[3], slope[3];
  // GIMP carries a uniform stress to the edge of a point's domain as the linear functions do.
  const int base =
      shape_along_axis(shape == Shape::bspline ? Shape::bspline : Shape::linear, xi, per_m, 0, weight, slope);
  const auto first = grid.low;
  long places = 1;
  for (int i = 0; i < D; ++i) places *= i == axis ? 1 : grid.count[i];
  for (long place = 0; place < places; ++place) {
    auto node = first;
    long rest = place;
    for (int i = 0; i < D; ++i) {
      if (i == axis) continue;
      node[i] += int(rest % grid.count[i]);
      rest /= grid.count[i];
    }
    SurfaceContact contact;
    contact.body = k;
    contact.normal = body.normal;
    contact.impulse.setZero();
    double sum = 0;
    bool near = false;  // soil reaches a node at the surface or behind it
    for (int j = 0; j < 3; ++j) {
      node[axis] = base + j;
      const int row = node[axis] - first[axis];
      if (!(weight[j] > 0) || row < 0 || row >= grid.count[axis]) continue;
      const long flat = grid.flat(node);
      if (!(grid.nodes[flat].mass > 0) || planes.is_behind(flat)) continue;
      near = near || (node[axis] - xi) * body.normal[axis] <= 1e-6;
      sum += weight[j];
      contact.node[contact.count] = flat;
      contact.weight[contact.count++] = weight[j];
    }
    if (!near) continue;
    for (int j = 0; j < contact.count; ++j) contact.weight[j] /= sum;
    surface_.push_back(contact);
  }
}

template <int D>
Vec<D> Bodies<D>::held(int body, const Vec<D>& normal, const Vec<D>& relative) const {
  const double across = relative.dot(normal);
  if (across >= 0) return relative;
  Vec<D> along = relative - across * normal;
  if (all[body].rough) {
    along.setZero();
  } else if (const double slip = along.norm(); slip > 0) {
    along *= std::max(0.0, 1 + all[body].friction * across / slip);
  }
  return along;
}

template <int D>
Vec<D> Bodies<D>::meet(const Contact& contact, const Vec<D>& speed, double* velocity) const {
  Vec<D> relative, jump;
  for (int i = 0; i < D; ++i) relative[i] = velocity[i] - speed[i];
  if (relative.dot(contact.normal) >= 0) return Vec<D>::Zero();
  const Vec<D> along = held(contact.body, contact.normal, relative);
  for (int i = 0; i < D; ++i) {
    const double met = speed[i] + along[i];
    jump[i] = met - velocity[i];
    velocity[i] = met;
  }
  return jump;
}

template <int D>
Vec<D> Bodies<D>::meet(const SurfaceContact& contact, const Vec<D>& speed, bool end, Grid<D>& grid) const {
  Vec<D> relative = -speed;
  double mobility = 0;  // of the surface: m/s of N s
  for (int j = 0; j < contact.count; ++j) {
    const auto& node = grid.nodes[contact.node[j]];
    const double* velocity = end ? node.w : node.v;
    for (int i = 0; i < D; ++i) relative[i] += contact.weight[j] * velocity[i];
    mobility += contact.weight[j] * contact.weight[j] / node.mass;
  }
  const Vec<D> impulse = (held(contact.body, contact.normal, relative) - relative) / mobility;
  for (int j = 0; j < contact.count; ++j) {
    auto& node = grid.nodes[contact.node[j]];
    double* velocity = end ? node.w : node.v;
    for (int i = 0; i < D; ++i) velocity[i] += contact.weight[j] / node.mass * impulse[i];
  }
  return impulse;
}

template <int D>
void Bodies<D>::set_start(Grid<D>& grid, double time) {
  for (auto& contact : contacts_) {
    auto& node = grid.nodes[contact.node];
    contact.jump = meet(contact, all[contact.body].velocity.at(time), node.v);
  }
  for (auto& contact : surface_) contact.impulse = meet(contact, all[contact.body].velocity.at(time), false, grid);
}

template <int D>
void Bodies<D>::book(int body, const Node<D>& node, int component, double impulse) {
  all[body].reaction.impulse[component] += impulse;
  all[body].reaction.work += 0.5 * impulse * (node.w[component] + node.a[component]);
}

template <int D>
void Bodies<D>::set_end(Grid<D>& grid, const Planes<D>& planes, double time) {
  for (auto& contact : contacts_) {
    auto& node = grid.nodes[contact.node];
    contact.jump += meet(contact, all[contact.body].velocity.at(time), node.w);
  }
  for (auto& contact : surface_) contact.impulse += meet(contact, all[contact.body].velocity.at(time), true, grid);
  // Work is done along the way that the node makes in the end, which a second body in it may have changed.
  for (const auto& contact : contacts_) {
    const auto& node = grid.nodes[contact.node];
    for (int i = 0; i < D; ++i) {
      if (!planes.holds(contact.node, i)) book(contact.body, node, i, node.mass * contact.jump[i]);
    }
  }
  for (const auto& contact : surface_) {
    for (int j = 0; j < contact.count; ++j) {
      for (int i = 0; i < D; ++i) {
        if (planes.holds(contact.node[j], i)) continue;
        book(contact.body, grid.nodes[contact.node[j]], i, contact.weight[j] * contact.impulse[i]);
      }
    }
  }
}

template struct Body<2>;
template struct Body<3>;
template class Bodies<2>;
template class Bodies<3>;

}  // namespace mpm
