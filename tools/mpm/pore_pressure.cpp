#include "tools/mpm/pore_pressure.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mpm {

template <int D>
void PorePressure<D>::follow(const Grid<D>& grid) {
  if (roles.size() == grid.nodes.size() && low_ == grid.low && count_ == grid.count) return;
  const std::vector<double> before = values;
  values.assign(grid.nodes.size(), 0);
  for (std::size_t at = 0; at < before.size(); ++at) {
    Index node;
    long rest = long(at);
    for (int i = 0; i < D; ++i) {
      node[i] = low_[i] + int(rest % count_[i]);
      rest /= count_[i];
    }
    if (grid.contains(node)) values[grid.flat(node)] = before[at];
  }
  low_ = grid.low;
  count_ = grid.count;
  roles.assign(grid.nodes.size(), Role::none);
  targets.assign(grid.nodes.size(), 0);
  columns_.resize(grid.nodes.size());
  number_.assign(grid.nodes.size(), -1);
  unknown_.clear();
}

template <int D>
void PorePressure<D>::clear(const Grid<D>& grid) {
  for (std::size_t at = 0; at < used_.size(); ++at) {
    if (used_[at]) columns_[at] = Columns{};
  }
  if (used_.size() != grid.nodes.size()) std::fill(columns_.begin(), columns_.end(), Columns{});
  used_.assign(grid.nodes.size(), 0);
  filled.assign(grid.nodes.size(), 0);
  cells_.assign(grid.nodes.size(), Cell{});
  std::fill(roles.begin(), roles.end(), Role::none);
  ties_.clear();
}

template <int D>
void PorePressure<D>::add(const Grid<D>& grid, const Support<D>& support, const Hat<D>& hat, double volume,
                          double porosity, double shear, double storage) {
  // Hats: value and slope times the volume, and their place from the lowest node of the support.
  double value[corners], slope[corners][D];
  int place[corners];
  Index first, lowest;
  for (int i = 0; i < D; ++i) first[i] = support.node[i], lowest[i] = hat.node[i];
  for (int c = 0; c < corners; ++c) {
    value[c] = volume;
    for (int i = 0; i < D; ++i) slope[c][i] = volume * porosity;
    Index node;
    for (int i = D - 1, at = 0; i >= 0; --i) {
      const int bit = c >> i & 1;
      node[i] = hat.node[i] + bit;
      at = at * 5 + node[i] - support.node[i] + 2;
      place[c] = at;
      value[c] *= hat.weight[i][bit];
      for (int j = 0; j < D; ++j) slope[c][j] *= j == i ? (bit ? 1 : -1) / grid.cell[i] : hat.weight[i][bit];
    }
    filled[grid.flat(node)] += value[c];
  }
  auto& cell = cells_[grid.flat(lowest)];
  cell.soft += 0.5 * volume / shear;
  cell.storage += storage * volume;
  Index node;
  const int layers = D == 3 ? 3 : 1;
  for (int k = 0; k < layers; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        const int from = i + 5 * j + 25 * k, of[3] = {i, j, k};
        double weight = 1, gradient[D];
        for (int a = 0; a < D; ++a) {
          node[a] = first[a] + of[a];
          weight *= support.weight[a][of[a]];
          gradient[a] = 1;
          for (int b = 0; b < D; ++b) gradient[a] *= a == b ? support.slope[b][of[b]] : support.weight[b][of[b]];
        }
        const long at = grid.flat(node);
        used_[at] = 1;
        auto& columns = columns_[at];
        for (int c = 0; c < corners; ++c) {
          for (int a = 0; a < D; ++a) {
            const double seepage = slope[c][a] * weight;
            columns.solid[a][place[c] - from] += value[c] * gradient[a] + seepage;
            columns.fluid[a][place[c] - from] -= seepage;
          }
        }
      }
    }
  }
}

template <int D>
void PorePressure<D>::gather_repeated(const Grid<D>& grid) {
  if (!repeats()) return;
  for (long at = 0; at < long(filled.size()); ++at) {
    Index node = grid.index(at);
    const Index before = node;
    wrap(node);
    if (node == before || !grid.contains(node)) continue;
    const long to = grid.flat(node);
    filled[to] += filled[at];
    cells_[to].soft += cells_[at].soft;
    cells_[to].storage += cells_[at].storage;
    filled[at] = 0;
    cells_[at] = Cell{};
    if (!used_[at]) continue;
    used_[at] = 0;
    used_[to] = 1;
    for (int i = 0; i < D; ++i) {
      for (int k = 0; k < reach; ++k) {
        columns_[to].solid[i][k] += columns_[at].solid[i][k];
        columns_[to].fluid[i][k] += columns_[at].fluid[i][k];
      }
    }
    columns_[at] = Columns{};
  }
}

template <int D>
void PorePressure<D>::copy_repeated(const Grid<D>& grid) {
  if (!repeats()) return;
  for (long at = 0; at < long(values.size()); ++at) {
    Index node = grid.index(at);
    wrap(node);
    if (grid.contains(node)) values[at] = values[grid.flat(node)];
  }
}

template <int D>
void PorePressure<D>::fold(const Grid<D>& grid, const Planes<D>& solid, const Planes<D>& fluid) {
  folded_of_.assign(grid.nodes.size(), -1);
  folded_columns_.clear();
  const auto& mirrors = solid.mirror_nodes();
  for (std::size_t m = 0; m < mirrors.size(); ++m) {
    const auto& mirror = mirrors[m];
    if (!used_[mirror.node]) continue;
    const auto& sign = fluid.mirror_nodes()[m].sign;
    if (folded_of_[mirror.image] < 0) {
      folded_of_[mirror.image] = int(folded_columns_.size());
      folded_columns_.push_back(columns_[mirror.image]);
      used_[mirror.image] = 1;
    }
    auto& image = folded_columns_[folded_of_[mirror.image]];
    const auto from = grid.index(mirror.node), to = grid.index(mirror.image);
    each_near(grid, from, 2, [&](long, int place) {
      int at = 0;
      bool inside = true;
      for (int i = D - 1; i >= 0; --i) {
        const int away = from[i] + offset(place, i) - to[i] + 2;
        inside = inside && away >= 0 && away < 5;
        at = at * 5 + away;
      }
      if (!inside) return;  // behind the plane, where no hat is
      for (int i = 0; i < D; ++i) {
        image.solid[i][at] += mirror.sign[i] * columns_[mirror.node].solid[i][place];
        image.fluid[i][at] += sign[i] * columns_[mirror.node].fluid[i][place];
      }
    });
  }
}

template <int D>
void PorePressure<D>::tie(const Grid<D>& grid) {
  constexpr double sliver = 0.01;  // of a hat
  const double whole = *std::max_element(filled.begin(), filled.end());
  for (long at = 0; at < long(filled.size()); ++at) {
    if (roles[at] != Role::unknown || filled[at] >= sliver * whole) continue;
    long fullest = at;
    each_near(grid, grid.index(at), 1, [&](long other, int) {
      if (roles[other] != Role::none && filled[other] > filled[fullest]) fullest = other;
    });
    if (fullest == at) continue;
    ties_.push_back({at, fullest, 0});
    values[at] = values[fullest];
  }
}

template <int D>
void PorePressure<D>::force(const Grid<D>& grid, long node, const std::vector<double>& p, bool with_mirrors,
                            double* solid, double* fluid) const {
  for (int i = 0; i < D; ++i) solid[i] = fluid[i] = 0;
  if (!used_[node]) return;
  const auto& columns = with_mirrors ? folded(node) : columns_[node];
  each_near(grid, grid.index(node), 2, [&](long hat, int place) {
    for (int i = 0; i < D; ++i) {
      solid[i] += columns.solid[i][place] * p[hat];
      fluid[i] += columns.fluid[i][place] * p[hat];
    }
  });
}

template <int D>
void PorePressure<D>::number_unknowns(const Grid<D>& grid) {
  std::vector<long> now;
  for (long at = 0; at < long(roles.size()); ++at) {
    if (roles[at] == Role::unknown) now.push_back(at);
  }
  if (now == unknown_ && factor_) return;
  unknown_ = now;
  factor_.reset();
  std::fill(number_.begin(), number_.end(), -1);
  for (std::size_t k = 0; k < unknown_.size(); ++k) number_[unknown_[k]] = int(k);
  const auto n = Eigen::Index(unknown_.size());
  matrix_.resize(n, n);
  std::vector<int> rows;
  std::vector<int> starts{0};
  for (const long at : unknown_) {
    each_near(grid, grid.index(at), 4, [&](long other, int) {
      if (number_[other] >= number_[at]) rows.push_back(number_[other]);
    });
    if (repeats()) {  // in few cells a node is met more than once
      std::sort(rows.begin() + starts.back(), rows.end());
      rows.erase(std::unique(rows.begin() + starts.back(), rows.end()), rows.end());
    }
    starts.push_back(int(rows.size()));
  }
  matrix_.makeCompressed();
  matrix_.resizeNonZeros(Eigen::Index(rows.size()));
  std::copy(rows.begin(), rows.end(), matrix_.innerIndexPtr());
  std::copy(starts.begin(), starts.end(), matrix_.outerIndexPtr());
  std::fill(matrix_.valuePtr(), matrix_.valuePtr() + rows.size(), 0.0);
}

/// Integrals of N_a N_b over a cell of volume 1, by how many axes their corners differ along; and less the product of
/// their means.
template <int D>
void PorePressure<D>::add_cells(const Grid<D>& grid, const Index& node, double dt, double* row) const {
  for (int mine = 0; mine < corners; ++mine) {
    Index lowest;
    for (int i = 0; i < D; ++i) lowest[i] = node[i] - (mine >> i & 1);
    wrap(lowest);
    if (!grid.contains(lowest)) continue;
    const auto& cell = cells_[grid.flat(lowest)];
    if (cell.soft == 0) continue;
    for (int other = 0; other < corners; ++other) {
      double shared = 1;
      int at = 0;
      for (int i = D - 1; i >= 0; --i) {
        const int away = (other >> i & 1) - (mine >> i & 1);
        shared *= away == 0 ? 1.0 / 3 : 1.0 / 6;
        at = at * 9 + away + 4;
      }
      row[at] += (cell.soft * (shared - 1.0 / (corners * corners)) + cell.storage * shared) / dt;
    }
  }
}

template <int D>
void PorePressure<D>::fill_row(const Grid<D>& grid, const std::vector<Mobility>& mobility, double dt, long at,
                               double* row) const {
  const auto node = grid.index(at);
  each_near(grid, node, 2, [&](long other, int place) {
    if (!used_[other] || mobility[other * D].solid < 0) return;
    const auto& columns = folded(other);
    const int mine = reach - 1 - place;
    // The other's window begins here in that of the row.
    int begin = 0;
    for (int i = D - 1; i >= 0; --i) begin = begin * 9 + offset(place, i) + 2;
    for (int a = 0; a < D; ++a) {
      const auto& m = mobility[other * D + a];
      const double solid = columns.solid[a][mine], fluid = columns.fluid[a][mine];
      const double s = dt * (m.solid * solid + m.both * fluid), f = dt * (m.both * solid + m.fluid * fluid);
      if (s == 0 && f == 0) continue;
      for (int k = 0; k < (D == 3 ? 5 : 1); ++k) {
        for (int j = 0; j < 5; ++j) {
          const double* cs = columns.solid[a] + 5 * j + 25 * k;
          const double* cf = columns.fluid[a] + 5 * j + 25 * k;
          double* out = row + begin + 9 * j + 81 * k;
          for (int i = 0; i < 5; ++i) out[i] += s * cs[i] + f * cf[i];
        }
      }
    }
  });
  add_cells(grid, node, dt, row);
}

/// Springs between this node and those that are tied to it, or that it is tied to.
template <int D>
void PorePressure<D>::add_ties(const Grid<D>& grid, long at, double* row) const {
  const auto place = [&](long other) {
    const auto node = grid.index(at), there = grid.index(other);
    int k = 0;
    for (int i = D - 1; i >= 0; --i) {
      int away = there[i] - node[i];
      if (std::abs(away) > 1) away += away < 0 ? period_[i] : -period_[i];  // neighbours
      k = k * 9 + away + 4;
    }
    return k;
  };
  for (const auto& tie : ties_) {
    if (tie.node != at && tie.to != at) continue;
    row[place(at)] += tie.stiffness;
    row[place(tie.node == at ? tie.to : tie.node)] -= tie.stiffness;
  }
}

/// A uniform pressure must meet something: a given node, a free surface, storage.
template <int D>
void PorePressure<D>::expect_datum(const Grid<D>& grid, const std::vector<Mobility>& mobility, double dt,
                                   Workers& workers) const {
  for (const auto role : roles) {
    if (role == Role::given) return;
  }
  std::vector<double> one(roles.size(), 0.0), held(roles.size(), 0.0);
  for (const long at : unknown_) one[at] = 1;
  stored(grid, one, dt, workers, held);
  double uniform = 0, scale = 0;
  for (const long at : unknown_) uniform += held[at];
  for (long node = 0; node < long(roles.size()); ++node) {
    if (!used_[node] || mobility[node * D].solid < 0) continue;
    double solid[D], fluid[D];
    force(grid, node, one, true, solid, fluid);
    for (int i = 0; i < D; ++i) {
      const auto& m = mobility[node * D + i];
      uniform +=
          dt * (m.solid * solid[i] * solid[i] + 2 * m.both * solid[i] * fluid[i] + m.fluid * fluid[i] * fluid[i]);
      for (int k = 0; k < reach; ++k) scale += dt * m.solid * folded(node).solid[i][k] * folded(node).solid[i][k];
    }
  }
  if (uniform > 1e-10 * scale) return;
  throw InputError(
      "fluid: the water is enclosed on all sides and cannot be compressed, so that its pressure has no datum; set "
      "drained = true (or pressure_Pa, head_m) at a boundary, or a finite fluid.bulk_modulus_Pa");
}

template <int D>
void PorePressure<D>::solve(const Grid<D>& grid, const std::vector<Mobility>& mobility,
                            const std::vector<double>& right, double dt, Workers& workers, std::vector<double>& dp) {
  const auto* before = factor_.get();
  number_unknowns(grid);
  const long n = unknowns();
  if (n == 0) return;
  const bool anew = before == nullptr || factor_.get() != before;
  if (anew) expect_datum(grid, mobility, dt, workers);
  for (auto& tie : ties_) {  // as stiff as the full neighbour is to all of its own
    std::vector<double> row(pattern, 0.0);
    fill_row(grid, mobility, dt, tie.to, row.data());
    tie.stiffness = row[pattern / 2];
  }
  const int* starts = matrix_.outerIndexPtr();
  double* value = matrix_.valuePtr();
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    std::vector<double> row(pattern);
    for (long k = long(piece) * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      const long at = unknown_[k];
      std::fill(row.begin(), row.end(), 0.0);
      fill_row(grid, mobility, dt, at, row.data());
      add_ties(grid, at, row.data());
      double* out = value + starts[k];
      if (repeats()) {
        const int* found = matrix_.innerIndexPtr();
        std::fill(out, value + starts[k + 1], 0.0);
        each_near(grid, grid.index(at), 4, [&](long other, int place) {
          if (number_[other] < k) return;
          value[std::lower_bound(found + starts[k], found + starts[k + 1], number_[other]) - found] += row[place];
        });
        continue;
      }
      each_near(grid, grid.index(at), 4, [&](long other, int place) {
        if (number_[other] >= k) *out++ = row[place];
      });
    }
  });
  Eigen::VectorXd b(n), x(n);
  for (long k = 0; k < n; ++k) b[k] = right[unknown_[k]];
  if constexpr (D == 2) {
    if (!factor_) {
      factor_ = std::make_unique<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>();
      factor_->analyzePattern(matrix_);
    }
    factor_->factorize(matrix_);
    if (factor_->info() == Eigen::Success)
      x = factor_->solve(b);
    else
      x.setConstant(NAN);
  } else {
    if (!factor_) factor_ = std::make_unique<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>();
    solve_space(b, x);
  }
  if (!x.allFinite()) throw std::runtime_error("the pore pressure cannot be found; take a smaller time.cfl");
  for (long k = 0; k < n; ++k) dp[unknown_[k]] = x[k];
}

/// Conjugate gradients: a factor in space would fill. They begin at zero.
template <int D>
void PorePressure<D>::solve_space(const Eigen::VectorXd& right, Eigen::VectorXd& solution) const {
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower> iteration;
  iteration.setTolerance(1e-10);
  iteration.compute(matrix_);
  solution = iteration.solve(right);
  if (iteration.info() != Eigen::Success) solution.setConstant(NAN);
}

template <int D>
void PorePressure<D>::stored(const Grid<D>& grid, const std::vector<double>& p, double dt, Workers& workers,
                             std::vector<double>& rate) const {
  over_nodes(grid, workers, [&](long at, const Index& node) {
    if (roles[at] == Role::none) return;
    std::vector<double> row(pattern, 0.0);
    add_cells(grid, node, dt, row.data());
    double sum = 0;
    each_near(grid, node, 4, [&](long other, int place) { sum += row[place] * p[other]; });
    rate[at] = sum;
  });
}

template class PorePressure<2>;
template class PorePressure<3>;

}  // namespace mpm
