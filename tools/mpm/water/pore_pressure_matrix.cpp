// The matrix of the pore pressure: its pattern, its rows, its solution. Declared in pore_pressure.hpp.
#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "tools/mpm/water/pore_pressure.hpp"

namespace mpm {

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
  const int from = repeats() ? 0 : pattern / 2;  // the upper half is what is read; where nodes repeat it is no half
  each_near(grid, node, 2, [&](long other, int local) {
    if (!used_[other] || mobility[other * D].solid < 0) return;
    const auto& columns = folded(other);
    const int mine = reach - 1 - local;
    // The other's window begins here in that of the row.
    int begin = 0;
    for (int i = D - 1; i >= 0; --i) begin = begin * 9 + offset(local, i) + 2;
    for (int a = 0; a < D; ++a) {
      const auto& m = mobility[other * D + a];
      const double solid = columns.solid[a][mine], fluid = columns.fluid[a][mine];
      const double s = dt * (m.solid * solid + m.both * fluid), f = dt * (m.both * solid + m.fluid * fluid);
      if (s == 0 && f == 0) continue;
      for (int k = 0; k < (D == 3 ? 5 : 1); ++k) {
        for (int j = 0; j < 5; ++j) {
          if (begin + 9 * j + 81 * k + 4 < from) continue;
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
  const auto local = [&](long other) {
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
    row[local(at)] += tie.stiffness;
    row[local(tie.node == at ? tie.to : tie.node)] -= tie.stiffness;
  }
}

/// A uniform pressure must meet something: a given node, a free surface, storage.
template <int D>
void PorePressure<D>::expect_datum(const Grid<D>& grid, const std::vector<Mobility>& mobility, double dt,
                                   rvelab::Workers& workers) const {
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
                            const std::vector<double>& right, double dt, rvelab::Workers& workers,
                            std::vector<double>& dp) {
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
        each_near(grid, grid.index(at), 4, [&](long other, int local) {
          if (number_[other] < k) return;
          value[std::lower_bound(found + starts[k], found + starts[k + 1], number_[other]) - found] += row[local];
        });
        continue;
      }
      each_near(grid, grid.index(at), 4, [&](long other, int local) {
        if (number_[other] >= k) *out++ = row[local];
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
void PorePressure<D>::stored(const Grid<D>& grid, const std::vector<double>& p, double dt, rvelab::Workers& workers,
                             std::vector<double>& rate) const {
  over_nodes(grid, workers, [&](long at, const Index& node) {
    if (roles[at] == Role::none) return;
    std::array<double, pattern> row{};
    add_cells(grid, node, dt, row.data());
    double sum = 0;
    each_near(grid, node, 1, [&](long other, int local) {
      int there = 0;
      for (int i = 0, left = local, stride = 1; i < D; ++i, left /= 3, stride *= 9) there += (left % 3 + 3) * stride;
      sum += row[there] * p[other];
    });
    rate[at] = sum;
  });
}

#define MPM_INSTANTIATE(D)                                                                                       \
  template void PorePressure<D>::solve(const Grid<D>&, const std::vector<Mobility>&, const std::vector<double>&, \
                                       double, rvelab::Workers&, std::vector<double>&);                          \
  template void PorePressure<D>::stored(const Grid<D>&, const std::vector<double>&, double, rvelab::Workers&,    \
                                        std::vector<double>&) const;
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
