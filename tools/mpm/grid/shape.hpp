// Shape functions of the background grid: weights of the three nodes an axis that a material point reaches.
//
// Quadratic B-spline: support of 1.5 cells to each side. GIMP (uniform): the linear function averaged over the point's
// own domain, which keeps its first size. Linear: two nodes, the third weight is zero, except within an eighth of a
// cell of a node, where the kink is rounded: there it is the average over a quarter of a cell. A kink has no slope at
// the node itself, and beside it one node has a share d of the point's mass and a whole share of its stress: its
// frequency grows as 1/sqrt(d), past any time step. Averaged over 2 h, h in cells, slope^2 over weight is 1/h at most.
// GIMP domains have at least that width.
#pragma once

#include <algorithm>
#include <cmath>

#include "tools/mpm/tensors.hpp"

namespace mpm {

enum class Shape { bspline, gimp, linear };

/// std::floor, which is a call where the processor is not known to have it; for |x| below 2^31.
inline double floor_of(double x) {
  const double whole = int(x);
  return whole > x ? whole - 1 : whole;
}

/// Of one point: number of its lowest node, weights and their gradients (1/m) along each axis.
template <int D>
struct Support {
  int node[D];
  double weight[D][3];
  double slope[D][3];
};

/// Cells, the least half width over which a linear function is averaged: stable up to cfl = 0.7.
inline constexpr double least_half = 0.125;

/// The two linear functions of a cell without rounding, at a place that carries no mass; xi: cells from node 0.
inline int hats_along_axis(double xi, double* weight) {
  const double base = floor_of(xi), d = xi - base;
  weight[0] = 1 - d;
  weight[1] = d;
  weight[2] = 0;
  return int(base);
}

/// xi: coordinate in cells from node 0; per_m: cells a metre; half: half the length of the point's domain over the
/// cell.
inline int shape_along_axis(Shape shape, double xi, double per_m, double half, double* weight, double* slope) {
  if (shape == Shape::bspline) {
    const double base = floor_of(xi - 0.5), d = xi - base;
    weight[0] = 0.5 * (1.5 - d) * (1.5 - d);
    weight[1] = 0.75 - (d - 1) * (d - 1);
    weight[2] = 0.5 * (d - 0.5) * (d - 0.5);
    slope[0] = (d - 1.5) * per_m;
    slope[1] = -2 * (d - 1) * per_m;
    slope[2] = (d - 0.5) * per_m;
    return int(base);
  }
  half = shape == Shape::linear ? least_half : std::clamp(half, least_half, 0.5);
  const double base = floor_of(xi - half);
  for (int k = 0; k < 3; ++k) {
    const double d = xi - base - k, a = std::abs(d), sign = d < 0 ? -1 : 1;
    if (a < half) {
      weight[k] = 1 - (d * d + half * half) / (2 * half);
      slope[k] = -d / half * per_m;
    } else if (a < 1 - half) {
      weight[k] = 1 - a;
      slope[k] = -sign * per_m;
    } else if (a < 1 + half) {
      weight[k] = (1 + half - a) * (1 + half - a) / (4 * half);
      slope[k] = -sign * (1 + half - a) / (2 * half) * per_m;
    } else {
      weight[k] = slope[k] = 0;
    }
  }
  return int(base);
}

}  // namespace mpm
