#include "tools/mpm/solver.hpp"

#include <chrono>

namespace mpm {
namespace {

constexpr long chunk = 1024;  // points of one piece of work; sums over pieces are made in their order
constexpr int slab_rows = 4;  // points of one slab and of the next but one share no node

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

int slab_of(int row) { return row >= 0 ? row / slab_rows : -((-row + slab_rows - 1) / slab_rows); }

/// visit(node, weight, slope, place) for each node that a point reaches; place: 0, 1 or 2 along each axis.
template <int D, class Nodes, class Visit>
inline void each_node(Nodes* nodes, const Grid<D>& grid, const Support<D>& s, Visit visit) {
  double slope[D], place[D];
  if constexpr (D == 2) {
    Nodes* row = nodes + (long(s.node[1] - grid.low[1]) * grid.count[0] + (s.node[0] - grid.low[0]));
    for (int j = 0; j < 3; ++j, row += grid.count[0]) {
      place[1] = j;
      for (int i = 0; i < 3; ++i) {
        place[0] = i;
        slope[0] = s.slope[0][i] * s.weight[1][j];
        slope[1] = s.weight[0][i] * s.slope[1][j];
        visit(row[i], s.weight[0][i] * s.weight[1][j], slope, place);
      }
    }
  } else {
    const long across = long(grid.count[0]) * grid.count[1];
    Nodes* first = nodes + ((s.node[2] - grid.low[2]) * across + long(s.node[1] - grid.low[1]) * grid.count[0] +
                            (s.node[0] - grid.low[0]));
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        Nodes* row = first + k * across + j * grid.count[0];
        const double both = s.weight[1][j] * s.weight[2][k];
        place[1] = j;
        place[2] = k;
        for (int i = 0; i < 3; ++i) {
          place[0] = i;
          slope[0] = s.slope[0][i] * both;
          slope[1] = s.weight[0][i] * s.slope[1][j] * s.weight[2][k];
          slope[2] = s.weight[0][i] * s.weight[1][j] * s.slope[2][k];
          visit(row[i], s.weight[0][i] * both, slope, place);
        }
      }
    }
  }
}

}  // namespace

template <int D>
const Range<D>& Solver<D>::range_of(long point) const {
  return *std::find_if(ranges.begin(), ranges.end(),
                       [&](const auto& range) { return point < range.first + range.count; });
}

template <int D>
double Solver<D>::stable_step() const {
  double wave = 0, fastest = 0;
  for (const auto& range : ranges) {
    double lightest = 1e300;
    for (long k = range.first; k < range.first + range.count; ++k) {
      lightest = std::min(lightest, points[k].mass / points[k].volume);
      fastest = std::max(fastest, points[k].velocity.squaredNorm());
    }
    if (range.count > 0) wave = std::max(wave, range.material->wave_modulus() / lightest);
  }
  return options.cfl * grid.cell.minCoeff() / (std::sqrt(wave) + std::sqrt(fastest));
}

template <int D>
void Solver<D>::place_grid() {
  if (follow_axis < 0) return;
  const auto& plane = planes.all[followed];
  const double span = plane.node * first_cell[follow_axis] + plane.velocity.way(time)[follow_axis];
  grid.cell[follow_axis] = span / plane.node;
}

template <int D>
void Solver<D>::find_supports() {
  const long n = long(points.size());
  supports_.resize(points.size());
  const long pieces = (n + chunk - 1) / chunk;
  using Index = typename Grid<D>::Index;
  std::vector<Index> low(pieces), high(pieces);
  workers.for_each(pieces, [&](std::int64_t piece) {
    for (int i = 0; i < D; ++i) low[piece][i] = 1 << 30, high[piece][i] = -(1 << 30);
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      for (int i = 0; i < D; ++i) {
        const double h = grid.cell[i];
        supports_[k].node[i] = shape_along_axis(options.shape, (points[k].position[i] - grid.anchor[i]) / h, h,
                                                points[k].half[i] / h, supports_[k].weight[i], supports_[k].slope[i]);
        low[piece][i] = std::min(low[piece][i], supports_[k].node[i]);
        high[piece][i] = std::max(high[piece][i], supports_[k].node[i] + 2);
      }
    }
  });
  for (long piece = 1; piece < pieces; ++piece) {
    for (int i = 0; i < D; ++i) {
      low[0][i] = std::min(low[0][i], low[piece][i]);
      high[0][i] = std::max(high[0][i], high[piece][i]);
    }
  }
  const bool grown = grid.cover(low[0], high[0]);
  if (grown || planes.changed(time)) planes.rebuild(grid, time);
}

template <int D>
void Solver<D>::sort_into_slabs() {
  const int first = slab_of(grid.low[D - 1]), last = slab_of(grid.low[D - 1] + grid.count[D - 1]);
  slab_begin_.assign(last - first + 2, 0);
  order_.resize(points.size());
  for (const auto& s : supports_) ++slab_begin_[slab_of(s.node[D - 1]) - first + 1];
  for (std::size_t k = 1; k < slab_begin_.size(); ++k) slab_begin_[k] += slab_begin_[k - 1];
  auto next = slab_begin_;
  for (std::size_t k = 0; k < supports_.size(); ++k) {
    order_[next[slab_of(supports_[k].node[D - 1]) - first]++] = long(k);
  }
  // Whether a slab comes with the even or the odd ones must not depend on where the box begins.
  if ((first & 1) != 0) slab_begin_.insert(slab_begin_.begin(), 0);
}

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
  Node<D>* nodes = grid.nodes.data();
  over_slabs([&](long k) {
    const auto& point = points[k];
    const auto& support = supports_[k];
    if (!options.affine) {
      double momentum[D];
      for (int i = 0; i < D; ++i) momentum[i] = point.mass * point.velocity[i];
      each_node<D>(nodes, grid, support, [&](Node<D>& node, double weight, const double*, const double*) {
        node.mass += weight * point.mass;
        for (int i = 0; i < D; ++i) node.v[i] += weight * momentum[i];
      });
      return;
    }
    // At the lowest node, and what each further one along an axis adds. Where the point was when it was mapped, `at`,
    // is that of its weights (MUSL maps again after the point has moved).
    double first[D], more[D][D];
    for (int i = 0; i < D; ++i) {
      first[i] = point.velocity[i];
      for (int j = 0; j < D; ++j) {
        const double at = support.weight[j][1] + 2 * support.weight[j][2];  // cells from the lowest node
        more[i][j] = point.mass * point.affine(i, j) * grid.cell[j];
        first[i] -= point.affine(i, j) * grid.cell[j] * at;
      }
      first[i] *= point.mass;
    }
    each_node<D>(nodes, grid, support, [&](Node<D>& node, double weight, const double*, const double* place) {
      node.mass += weight * point.mass;
      for (int i = 0; i < D; ++i) {
        double momentum = first[i];
        for (int j = 0; j < D; ++j) momentum += more[i][j] * place[j];
        node.v[i] += weight * momentum;
      }
    });
  });
}

template <int D>
void Solver<D>::map_force() {
  Node<D>* nodes = grid.nodes.data();
  over_slabs([&](long k) {
    const auto& point = points[k];
    double stress[D][D], force[D];
    Vec<D> b = options.gravity;
    if (body_force) b += body_force(point.position, time);
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j < D; ++j) {
        stress[i][j] = -point.volume * (point.stress(i, j) + (i == j ? options.surface_pressure : 0));
      }
      force[i] = point.mass * b[i];
    }
    each_node<D>(nodes, grid, supports_[k], [&](Node<D>& node, double weight, const double* slope, const double*) {
      for (int i = 0; i < D; ++i) {
        double sum = weight * force[i];
        for (int j = 0; j < D; ++j) sum += stress[i][j] * slope[j];
        node.w[i] += sum;
      }
    });
  });
}

template <int D>
void Solver<D>::start_velocities() {
  for (auto& node : grid.nodes) {
    if (!(node.mass > 0)) continue;
    for (int i = 0; i < D; ++i) node.a[i] = node.v[i] = node.v[i] / node.mass;
  }
  planes.fold_momentum(grid, time);
  planes.set_start(grid, time);
  planes.keep_brought(grid);
  bodies.find(grid, planes, time);
  bodies.set_start(grid, time);
  planes.set_start(grid, time);
}

template <int D>
void Solver<D>::end_velocities(double dt) {
  planes.fold_force(grid);
  bodies.keep_force(grid);
  for (auto& node : grid.nodes) {
    if (!(node.mass > 0)) continue;
    for (int i = 0; i < D; ++i) node.w[i] = node.v[i] + dt * (node.w[i] / node.mass);
  }
  bodies.set_end(grid, planes, time + dt, dt);
  planes.set_end(grid, time + dt);
  planes.unfold(grid);
  double kinetic = 0;
  for (auto& node : grid.nodes) {
    if (!(node.mass > 0)) continue;
    double change = 0;
    for (int i = 0; i < D; ++i) {
      const double brought = node.a[i];
      node.a[i] = node.w[i] - brought;
      change += node.a[i] * (node.w[i] + brought);
    }
    kinetic += 0.5 * node.mass * change;
  }
  ledger.nodal_kinetic += kinetic;
  planes.react(grid, dt, options.pic_fraction);
}

template <int D>
void Solver<D>::gradients(double dt) {
  const Node<D>* nodes = grid.nodes.data();
  const long n = long(points.size());
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      auto& point = points[k];
      double L[D][D] = {};
      each_node<D>(nodes, grid, supports_[k], [&](const Node<D>& node, double, const double* slope, const double*) {
        for (int i = 0; i < D; ++i) {
          for (int j = 0; j < D; ++j) L[i][j] += node.v[i] * slope[j];
        }
      });
      double power = 0;
      for (int i = 0; i < D; ++i) {
        for (int j = 0; j < D; ++j) {
          point.gradient(i, j) = dt * L[i][j];
          power += point.stress(i, j) * point.gradient(i, j);
        }
      }
      point.work += 0.5 * point.volume * power;
    }
  });
}

template <int D>
void Solver<D>::stresses(double dt) {
  const double begin = now();
  for (auto& range : ranges) range.material->advance(points.data() + range.first, range.count, dt, workers);
  material_seconds += now() - begin;
  const long n = long(points.size());
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      auto& point = points[k];
      const Mat<D> dH = finite_increment<D>(point.gradient);
      point.strain += 0.5 * (dH + dH.transpose());
      point.volume *= (Mat<D>::Identity() + dH).determinant();
      point.F = (point.F + dH * point.F).eval();
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
      double w[D] = {}, a[D] = {}, slopes[D][D] = {};
      each_node<D>(nodes, grid, supports_[k],
                   [&](const Node<D>& node, double weight, const double* slope, const double*) {
                     for (int i = 0; i < D; ++i) {
                       w[i] += weight * node.w[i];
                       a[i] += weight * node.a[i];
                       if (affine) {
                         for (int j = 0; j < D; ++j) slopes[i][j] += node.w[i] * slope[j];
                       }
                     }
                   });
      for (int i = 0; i < D; ++i) {
        point.velocity[i] = pic * w[i] + (1 - pic) * (point.velocity[i] + a[i]);
        point.position[i] += dt * w[i];
        if (affine) {
          for (int j = 0; j < D; ++j) point.affine(i, j) = slopes[i][j];
        }
      }
    }
  });
}

/// MUSL: nodal velocities from what the points have now, at the weights that the step began with.
template <int D>
void Solver<D>::second_map(double dt) {
  grid.clear();
  map_momentum();
  for (auto& node : grid.nodes) {
    if (!(node.mass > 0)) continue;
    for (int i = 0; i < D; ++i) node.a[i] = node.v[i] = node.v[i] / node.mass;
  }
  planes.fold_momentum(grid, time + dt);
  bodies.set_start(grid, time + dt);
  planes.set_start(grid, time + dt);
}

template <int D>
void Solver<D>::step(double dt) {
  const double begin = now(), before = material_seconds;
  place_grid();
  find_supports();
  sort_into_slabs();
  grid.clear();
  map_momentum();
  start_velocities();
  if (options.scheme == Scheme::usf) {
    gradients(dt);
    stresses(dt);
    map_force();
    end_velocities(dt);
    move_points(dt);
  } else {
    map_force();
    end_velocities(dt);
    move_points(dt);
    second_map(dt);
    gradients(dt);
    stresses(dt);
  }
  time += dt;
  ++steps;
  grid_seconds += now() - begin - (material_seconds - before);
}

template class Solver<2>;
template class Solver<3>;

}  // namespace mpm
