// What a point gives to the nodes of its support and takes from them, for any phase: its momentum, its forces, the
// velocity at its place.
#pragma once

#include "tools/mpm/grid/grid.hpp"
#include "tools/mpm/grid/shape.hpp"

namespace mpm {

/// visit(nodes, across, slope, node) for each row of three nodes along x that a point reaches. across: product of the
/// weights along the other axes; slope: the same with the slope along one of them; node: 0, 1 or 2 along each. What is
/// linear in the weights is then summed over a row first: three nodes cost little more than one.
template <int D, class Nodes, class Visit>
inline void each_row(Nodes* nodes, const Grid<D>& grid, const Support<D>& s, Visit visit) {
  if constexpr (D == 2) {
    Nodes* row = nodes + (long(s.node[1] - grid.low[1]) * grid.count[0] + (s.node[0] - grid.low[0]));
    for (int j = 0; j < 3; ++j, row += grid.count[0]) {
      const double slope[1] = {s.slope[1][j]}, node[1] = {double(j)};
      visit(row, s.weight[1][j], slope, node);
    }
  } else {
    const long layer = long(grid.count[0]) * grid.count[1];
    Nodes* first = nodes + ((s.node[2] - grid.low[2]) * layer + long(s.node[1] - grid.low[1]) * grid.count[0] +
                            (s.node[0] - grid.low[0]));
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        const double slope[2] = {s.slope[1][j] * s.weight[2][k], s.weight[1][j] * s.slope[2][k]};
        const double node[2] = {double(j), double(k)};
        visit(first + k * layer + j * grid.count[0], s.weight[1][j] * s.weight[2][k], slope, node);
      }
    }
  }
}

/// A vector at a node in whole registers.
template <int D>
using Lanes = double[Node<D>::lanes];

/// Adds the part of a row to grad v = sum v (x) grad N, L[j] its column j; along, steep: sums of v times weight and
/// slope along x.
template <int D>
inline void add_gradient(Lanes<D> (&L)[D], const Lanes<D>& along, const Lanes<D>& steep, double across,
                         const double* slope) {
  for (int i = 0; i < Node<D>::lanes; ++i) L[0][i] += steep[i] * across;
  for (int j = 1; j < D; ++j) {
    for (int i = 0; i < Node<D>::lanes; ++i) L[j][i] += along[i] * slope[j - 1];
  }
}

/// Mass and momentum m (v + A (x - x_p)) of a point to its nodes. `affine`: with A, its velocity gradient (1/s). Where
/// the point was when it was mapped is that of its weights (MUSL maps again after the point has moved).
template <int D>
inline void give_momentum(Grid<D>& grid, const Support<D>& support, double mass, const Vec<D>& velocity,
                          const Mat<D>& gradient, bool affine) {
  constexpr int lanes = Node<D>::lanes;
  // Momentum at the lowest node, and what each further one along an axis adds.
  Lanes<D> first = {}, more[D] = {};  // more[j]: along axis j
  for (int i = 0; i < D; ++i) first[i] = mass * velocity[i];
  for (int j = 0; j < D; ++j) {
    const double at = support.weight[j][1] + 2 * support.weight[j][2];  // cells from the lowest node
    for (int i = 0; i < D; ++i) {
      more[j][i] = affine ? mass * gradient(i, j) * grid.cell[j] : 0;
      first[i] -= more[j][i] * at;
    }
  }
  each_row<D>(grid.nodes.data(), grid, support, [&](Node<D>* row, double across, const double*, const double* node) {
    Lanes<D> momentum;
    for (int i = 0; i < lanes; ++i) {
      momentum[i] = first[i];
      for (int j = 1; j < D; ++j) momentum[i] += more[j][i] * node[j - 1];
    }
    for (int r = 0; r < 3; ++r) {
      const double weight = support.weight[0][r] * across;
      row[r].mass += weight * mass;
      for (int i = 0; i < lanes; ++i) row[r].v[i] += weight * (momentum[i] + r * more[0][i]);
    }
  });
}

/// Nodal forces -V sigma grad N + f N. stress[j]: -V sigma on a face across axis j; force: f.
template <int D>
inline void give_force(Grid<D>& grid, const Support<D>& support, const Lanes<D> (&stress)[D], const Lanes<D>& force) {
  constexpr int lanes = Node<D>::lanes;
  each_row<D>(grid.nodes.data(), grid, support, [&](Node<D>* row, double across, const double* slope, const double*) {
    Lanes<D> steep, even;  // N for a unit of slope and of weight along x
    for (int i = 0; i < lanes; ++i) {
      steep[i] = stress[0][i] * across;
      even[i] = force[i] * across;
      for (int j = 1; j < D; ++j) even[i] += stress[j][i] * slope[j - 1];
    }
    for (int r = 0; r < 3; ++r) {
      for (int i = 0; i < lanes; ++i) {
        row[r].w[i] += support.slope[0][r] * steep[i] + support.weight[0][r] * even[i];
      }
    }
  });
}

/// Velocities at a point at the end of a step: w (nodal), what the step added, and the gradient of w.
template <int D>
struct Taken {
  Lanes<D> w = {}, added = {}, gradient[D] = {};  ///< gradient[j]: d/dx_j
};

template <int D>
inline void take_velocity(const Grid<D>& grid, const Support<D>& support, Taken<D>& taken) {
  each_row<D>(grid.nodes.data(), grid, support,
              [&](const Node<D>* row, double across, const double* slope, const double*) {
                Lanes<D> along = {}, steep = {}, added = {};
                for (int r = 0; r < 3; ++r) {
                  for (int i = 0; i < Node<D>::lanes; ++i) {
                    along[i] += support.weight[0][r] * row[r].w[i];
                    steep[i] += support.slope[0][r] * row[r].w[i];
                    added[i] += support.weight[0][r] * row[r].a[i];
                  }
                }
                for (int i = 0; i < Node<D>::lanes; ++i) {
                  taken.w[i] += along[i] * across;
                  taken.added[i] += added[i] * across;
                }
                add_gradient<D>(taken.gradient, along, steep, across, slope);
              });
}

}  // namespace mpm
