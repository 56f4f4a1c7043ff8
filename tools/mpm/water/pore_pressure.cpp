#include "tools/mpm/water/pore_pressure.hpp"

#include <algorithm>

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
  // Hats: value and slope times the volume, and their number from the lowest node of the support.
  double value[corners], slope[corners][D];
  int local[corners];
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
      local[c] = at;
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
            columns.solid[a][local[c] - from] += value[c] * gradient[a] + seepage;
            columns.fluid[a][local[c] - from] -= seepage;
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
    each_near(grid, from, 2, [&](long, int local) {
      int at = 0;
      bool inside = true;
      for (int i = D - 1; i >= 0; --i) {
        const int away = from[i] + offset(local, i) - to[i] + 2;
        inside = inside && away >= 0 && away < 5;
        at = at * 5 + away;
      }
      if (!inside) return;  // behind the plane, where no hat is
      for (int i = 0; i < D; ++i) {
        image.solid[i][at] += mirror.sign[i] * columns_[mirror.node].solid[i][local];
        image.fluid[i][at] += sign[i] * columns_[mirror.node].fluid[i][local];
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
  each_near(grid, grid.index(node), 2, [&](long hat, int local) {
    for (int i = 0; i < D; ++i) {
      solid[i] += columns.solid[i][local] * p[hat];
      fluid[i] += columns.fluid[i][local] * p[hat];
    }
  });
}

#define MPM_INSTANTIATE(D)                                                                                     \
  template void PorePressure<D>::follow(const Grid<D>&);                                                       \
  template void PorePressure<D>::clear(const Grid<D>&);                                                        \
  template void PorePressure<D>::add(const Grid<D>&, const Support<D>&, const Hat<D>&, double, double, double, \
                                     double);                                                                  \
  template void PorePressure<D>::gather_repeated(const Grid<D>&);                                              \
  template void PorePressure<D>::copy_repeated(const Grid<D>&);                                                \
  template void PorePressure<D>::fold(const Grid<D>&, const Planes<D>&, const Planes<D>&);                     \
  template void PorePressure<D>::tie(const Grid<D>&);                                                          \
  template void PorePressure<D>::force(const Grid<D>&, long, const std::vector<double>&, bool, double*, double*) const;
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
