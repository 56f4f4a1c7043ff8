// What points give to nodes and take from them: where the time of the continuum goes.
#include "tools/mpm/solver.hpp"

namespace mpm {
namespace {

/// visit(nodes, across, slope, place) for each row of three nodes along x that a point reaches. across: product of the
/// weights along the other axes; slope: the same with the slope along one of them; place: 0, 1 or 2 along each. What is
/// linear in the weights is then summed over a row first: three nodes cost little more than one.
template <int D, class Nodes, class Visit>
inline void each_row(Nodes* nodes, const Grid<D>& grid, const Support<D>& s, Visit visit) {
  if constexpr (D == 2) {
    Nodes* row = nodes + (long(s.node[1] - grid.low[1]) * grid.count[0] + (s.node[0] - grid.low[0]));
    for (int j = 0; j < 3; ++j, row += grid.count[0]) {
      const double slope[1] = {s.slope[1][j]}, place[1] = {double(j)};
      visit(row, s.weight[1][j], slope, place);
    }
  } else {
    const long layer = long(grid.count[0]) * grid.count[1];
    Nodes* first = nodes + ((s.node[2] - grid.low[2]) * layer + long(s.node[1] - grid.low[1]) * grid.count[0] +
                            (s.node[0] - grid.low[0]));
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        const double slope[2] = {s.slope[1][j] * s.weight[2][k], s.weight[1][j] * s.slope[2][k]};
        const double place[2] = {double(j), double(k)};
        visit(first + k * layer + j * grid.count[0], s.weight[1][j] * s.weight[2][k], slope, place);
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

}  // namespace

/// work(point) in parallel, in an order of sums that no number of threads changes: even slabs, then odd ones.
template <int D>
template <class Work>
void Solver<D>::over_slabs(const Work& work) {
  const long slabs = long(slab_begin_.size()) - 1;
  for (const long parity : {0L, 1L}) {
    workers.for_each((slabs - parity + 1) / 2, [&](std::int64_t piece) {
      const long slab = 2 * piece + parity;
      for (long k = slab_begin_[slab]; k < slab_begin_[slab + 1]; ++k) work(order_[k]);
    });
  }
}

template <int D>
void Solver<D>::map_momentum() {
  constexpr int lanes = Node<D>::lanes;
  Node<D>* nodes = grid.nodes.data();
  over_slabs([&](long k) {
    const auto& point = points[k];
    const auto& support = supports_[k];
    // Momentum at the lowest node, and what each further one along an axis adds. Where the point was when it was
    // mapped, `at`, is that of its weights (MUSL maps again after the point has moved).
    const double mass = point.mass;
    Lanes<D> first = {}, more[D] = {};  // more[j]: along axis j
    for (int i = 0; i < D; ++i) first[i] = mass * point.velocity[i];
    for (int j = 0; j < D; ++j) {
      const double at = support.weight[j][1] + 2 * support.weight[j][2];  // cells from the lowest node
      for (int i = 0; i < D; ++i) {
        more[j][i] = options.affine ? mass * point.affine(i, j) * grid.cell[j] : 0;
        first[i] -= more[j][i] * at;
      }
    }
    each_row<D>(nodes, grid, support, [&](Node<D>* row, double across, const double*, const double* place) {
      Lanes<D> momentum;
      for (int i = 0; i < lanes; ++i) {
        momentum[i] = first[i];
        for (int j = 1; j < D; ++j) momentum[i] += more[j][i] * place[j - 1];
      }
      for (int r = 0; r < 3; ++r) {
        const double weight = support.weight[0][r] * across;
        row[r].mass += weight * mass;
        for (int i = 0; i < lanes; ++i) row[r].v[i] += weight * (momentum[i] + r * more[0][i]);
      }
    });
  });
}

template <int D>
void Solver<D>::map_force() {
  constexpr int lanes = Node<D>::lanes;
  Node<D>* nodes = grid.nodes.data();
  over_slabs([&](long k) {
    const auto& point = points[k];
    const auto& support = supports_[k];
    Lanes<D> stress[D] = {}, force = {};  // stress[j]: times -V, on a face across axis j
    Vec<D> b = options.gravity;
    if (body_force) b += body_force(point.position, time);
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) {
        stress[j][i] = -point.volume * (point.stress(i, j) + (i == j ? options.surface_pressure : 0));
      }
      force[i] = point.mass * b[i];
    }
    each_row<D>(nodes, grid, support, [&](Node<D>* row, double across, const double* slope, const double*) {
      Lanes<D> steep, even;  // N for a unit of slope and of weight along x
      for (int i = 0; i < lanes; ++i) {
        steep[i] = stress[0][i] * across;
        even[i] = force[i] * across;
        for (int j = 1; j < D; ++j) even[i] += stress[j][i] * slope[j - 1];
      }
      for (int r = 0; r < 3; ++r) {
        for (int i = 0; i < lanes; ++i) row[r].w[i] += support.slope[0][r] * steep[i] + support.weight[0][r] * even[i];
      }
    });
  });
}

template <int D>
void Solver<D>::gradients(double dt) {
  const Node<D>* nodes = grid.nodes.data();
  const long n = long(points.size());
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      auto& point = points[k];
      const auto& support = supports_[k];
      Lanes<D> L[D] = {};
      each_row<D>(nodes, grid, support, [&](const Node<D>* row, double across, const double* slope, const double*) {
        Lanes<D> along = {}, steep = {};
        for (int r = 0; r < 3; ++r) {
          for (int i = 0; i < Node<D>::lanes; ++i) {
            along[i] += support.weight[0][r] * row[r].v[i];
            steep[i] += support.slope[0][r] * row[r].v[i];
          }
        }
        add_gradient<D>(L, along, steep, across, slope);
      });
      Mat<D> step;
      for (int i = 0; i < D; ++i) {
        for (int j = 0; j < D; ++j) step(i, j) = dt * L[j][i];
      }
      // USF has the velocities that points came with, at where they came to; MUSL those that they went with, at where
      // they went from.
      point.gradient = options.scheme == Scheme::usf ? strain_of_step<D>(step) : Mat<D>(-strain_of_step<D>(-step));
      if (options.scheme == Scheme::musl) point.affine = carried_gradient<D>(point.affine, dt);
      point.work += 0.5 * point.volume * point.stress.cwiseProduct(point.gradient).sum();
    }
  });
}

template <int D>
void Solver<D>::move_points(double dt) {
  const Node<D>* nodes = grid.nodes.data();
  const long n = long(points.size());
  const double pic = options.pic_fraction;
  const bool affine = options.affine;
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      auto& point = points[k];
      const auto& support = supports_[k];
      Lanes<D> w = {}, a = {}, L[D] = {};
      each_row<D>(nodes, grid, support, [&](const Node<D>* row, double across, const double* slope, const double*) {
        Lanes<D> along = {}, steep = {}, added = {};
        for (int r = 0; r < 3; ++r) {
          for (int i = 0; i < Node<D>::lanes; ++i) {
            along[i] += support.weight[0][r] * row[r].w[i];
            steep[i] += support.slope[0][r] * row[r].w[i];
            added[i] += support.weight[0][r] * row[r].a[i];
          }
        }
        for (int i = 0; i < Node<D>::lanes; ++i) {
          w[i] += along[i] * across;
          a[i] += added[i] * across;
        }
        if (affine) add_gradient<D>(L, along, steep, across, slope);
      });
      for (int i = 0; i < D; ++i) {
        point.velocity[i] = pic * w[i] + (1 - pic) * (point.velocity[i] + a[i]);
        point.position[i] += dt * w[i];
        for (int j = 0; j < D; ++j) point.affine(i, j) = L[j][i];
      }
      if (options.scheme == Scheme::usf) point.affine = carried_gradient<D>(point.affine, dt);
    }
  });
}

template void Solver<2>::map_momentum();
template void Solver<2>::map_force();
template void Solver<2>::gradients(double);
template void Solver<2>::move_points(double);
template void Solver<3>::map_momentum();
template void Solver<3>::map_force();
template void Solver<3>::gradients(double);
template void Solver<3>::move_points(double);

}  // namespace mpm
