// A point of a surface at which the soil's velocity sum N_I v_I is held by impulses J, which the nodes get as N_I J.
#pragma once

#include <algorithm>

#include "tools/mpm/bodies/planes.hpp"
#include "tools/mpm/grid/shape.hpp"

namespace mpm {

/// The nodes that reach it, and their weights there, of sum 1.
template <int D>
struct SurfacePoint {
  static constexpr int reach = D == 2 ? 9 : 27;
  int owner;  ///< number of the body, or of the rock
  Vec<D> normal;
  long node[reach];
  double weight[reach];
  int count = 0;
  double mobility = 0;  ///< m/s of N s: sum of weight^2/mass
  /// N s, of the body on the soil: while the sweeps go on, at the start, at the end of the step.
  Vec<D> now, at_start, at_end;

  /// m/s, of the soil, at the start or the end of the step.
  Vec<D> velocity(const Grid<D>& grid, bool end) const {
    Vec<D> sum = Vec<D>::Zero();
    for (int j = 0; j < count; ++j) {
      const auto& at = grid.nodes[node[j]];
      for (int i = 0; i < D; ++i) sum[i] += weight[j] * (end ? at.w : at.v)[i];
    }
    return sum;
  }
  void push(Grid<D>& grid, const Vec<D>& impulse, bool end) const {
    for (int j = 0; j < count; ++j) {
      auto& at = grid.nodes[node[j]];
      for (int i = 0; i < D; ++i) (end ? at.w : at.v)[i] += weight[j] / at.mass * impulse[i];
    }
  }
  /// A node that reaches it, if it has soil of its own and is no mirror node.
  void add_node(const Grid<D>& grid, const Planes<D>& planes, const typename Grid<D>::Index& index, double share) {
    if (!(share > 0) || !grid.contains(index)) return;
    const long flat = grid.flat(index);
    if (!(grid.nodes[flat].mass > 0) || planes.is_mirror(flat)) return;
    node[count] = flat;
    weight[count++] = share;
  }
  /// All nodes that reach a place, which is in the box of the grid.
  void add_nodes(const Grid<D>& grid, const Planes<D>& planes, Shape shape, const Vec<D>& at) {
    typename Grid<D>::Index base;
    double along[D][3];
    for (int i = 0; i < D; ++i) {
      base[i] = surface_weights(shape, (at[i] - grid.anchor[i]) / grid.cell[i], along[i]);
    }
    for (int n = 0; n < reach; ++n) {
      const int j[3] = {n % 3, n / 3 % 3, n / 9};
      auto index = base;
      double product = 1;
      for (int i = 0; i < D; ++i) {
        index[i] += j[i];
        product *= along[i][j[i]];
      }
      add_node(grid, planes, index, product);
    }
  }
  /// Completes it; false: no node with soil reaches it. A node of little mass, which the soil only just reaches, would
  /// take the impulse and leave the soil where it is (a plate on an elastic block: 16 % of the stress lost): it is left
  /// out, and `light(node)` is called.
  template <class Light>
  bool complete(const Grid<D>& grid, const Light& light) {
    if (count == 0) return false;
    constexpr double little = 0.1;  // of the mass per weight at the node of most weight
    const int most = int(std::max_element(weight, weight + count) - weight);
    const double usual = grid.nodes[node[most]].mass / weight[most];
    double sum = 0;
    int kept = 0;
    for (int j = 0; j < count; ++j) {
      if (grid.nodes[node[j]].mass < little * usual * weight[j]) {
        light(node[j]);
        continue;
      }
      node[kept] = node[j];
      weight[kept++] = weight[j];
      sum += weight[j];
    }
    count = kept;
    for (int j = 0; j < count; ++j) {
      weight[j] /= sum;
      mobility += weight[j] * weight[j] / grid.nodes[node[j]].mass;
    }
    return true;
  }
  /// Weights at a point of a surface along one axis. GIMP carries a uniform stress to the edge of a point's domain as
  /// the linear functions do.
  static int surface_weights(Shape shape, double xi, double* weight) {
    if (shape != Shape::bspline) return hats_along_axis(xi, weight);
    double slope[3];
    return shape_along_axis(Shape::bspline, xi, 1, 0, weight, slope);
  }
};

/// J, of impulses (N s) of one component at the start and at the end of the step, over the changes of the velocity at a
/// node.
template <int D>
double work_at(const Node<D>& node, int i, double at_start, double at_end) {
  return 0.5 * (at_start * (node.a[i] + node.v[i]) + at_end * (node.v[i] + node.w[i]));
}

}  // namespace mpm
