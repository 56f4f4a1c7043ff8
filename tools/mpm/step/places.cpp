// Where points and nodes are in a step: the grid, the supports of the points, and their order in slabs. Declared in
// solver.hpp.
#include <sstream>

#include "tools/mpm/step/solver.hpp"

namespace mpm {
namespace {

constexpr int slab_rows = 4;  // points of one slab and of the next but one share no node

constexpr double farthest_node = 1e9;  // their numbers are int

template <int D>
[[noreturn]] void throw_flown(const Vec<D>& at, const std::string& material, double time) {
  std::ostringstream words;
  words << "at " << time << " s a point of material " << material << " is at " << at.transpose()
        << " m, more than 1e9 cells from 0; take a smaller time.cfl, or a load that the soil can carry";
  throw std::runtime_error(words.str());
}

int slab_of(int row) { return row >= 0 ? row / slab_rows : -((-row + slab_rows - 1) / slab_rows); }

}  // namespace

/// Grid, supports and slabs of this step's places.
template <int D>
void Solver<D>::begin_step() {
  place_grid();
  find_supports();
  sort_into_slabs();
  clear(grid);
}

template <int D>
void Solver<D>::place_grid() {
  if (follow_axis < 0) return;
  const auto& plane = planes.all[followed];
  const double span = plane.node * first_cell[follow_axis] + plane.velocity.displacement(time)[follow_axis];
  grid.cell[follow_axis] = span / plane.node;
}

template <int D>
void Solver<D>::find_supports() {
  const long n = long(points.size());
  supports_.resize(points.size());
  const long pieces = (n + chunk - 1) / chunk;
  using Index = typename Grid<D>::Index;
  std::vector<Index> low(pieces), high(pieces);
  const Vec<D> per_m = grid.cell.cwiseInverse();
  workers.for_each(pieces, [&](std::int64_t piece) {
    Index least, most;  // not in place: neighbours share cache lines (two threads: 2.09 s of 3.09, so 1.75)
    for (int i = 0; i < D; ++i) least[i] = 1 << 30, most[i] = -(1 << 30);
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      for (int i = 0; i < D; ++i) {
        const double xi = (points[k].position[i] - grid.anchor[i]) * per_m[i];
        if (!(std::abs(xi) < farthest_node)) throw_flown(points[k].position, group_of(k).name, time);
        supports_[k].node[i] = shape_along_axis(options.shape, xi, per_m[i], points[k].half[i] * per_m[i],
                                                supports_[k].weight[i], supports_[k].slope[i]);
        least[i] = std::min(least[i], supports_[k].node[i]);
        most[i] = std::max(most[i], supports_[k].node[i] + 2);
      }
    }
    low[piece] = least;
    high[piece] = most;
  });
  for (long piece = 1; piece < pieces; ++piece) {
    for (int i = 0; i < D; ++i) {
      low[0][i] = std::min(low[0][i], low[piece][i]);
      high[0][i] = std::max(high[0][i], high[piece][i]);
    }
  }
  const bool grown = grid.cover(low[0], high[0], Grid<D>::most_for(n));
  if (grown || planes.changed(time)) planes.rebuild(grid, time);
}

/// Points by slabs, within them in their order: pieces of points are counted, then each puts its own in place.
template <int D>
void Solver<D>::sort_into_slabs() {
  const int first = slab_of(grid.low[D - 1]), last = slab_of(grid.low[D - 1] + grid.count[D - 1]);
  const long n = long(points.size()), pieces = (n + chunk - 1) / chunk, slabs = last - first + 1;
  const auto each_slab = [&](std::int64_t piece, const auto& visit) {
    for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) {
      visit(k, slab_next_[piece * slabs + slab_of(supports_[k].node[D - 1]) - first]);
    }
  };
  slab_next_.assign(pieces * slabs, 0);
  workers.for_each(pieces, [&](std::int64_t piece) { each_slab(piece, [](long, long& count) { ++count; }); });
  slab_begin_.assign(1, 0);
  long at = 0;
  for (long slab = 0; slab < slabs; ++slab) {
    for (long piece = 0; piece < pieces; ++piece) {
      const long count = slab_next_[piece * slabs + slab];
      slab_next_[piece * slabs + slab] = at;
      at += count;
    }
    slab_begin_.push_back(at);
  }
  order_.resize(points.size());
  workers.for_each(pieces,
                   [&](std::int64_t piece) { each_slab(piece, [&](long k, long& next) { order_[next++] = k; }); });
  // Whether a slab comes with the even or the odd ones must not depend on where the box begins.
  if ((first & 1) != 0) slab_begin_.insert(slab_begin_.begin(), 0);
}

template <int D>
void Solver<D>::clear(Grid<D>& of) {
  const long n = long(of.nodes.size());
  workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
    const long from = long(piece) * chunk;
    of.clear(from, std::min(n, from + chunk));
  });
}

#define MPM_INSTANTIATE(D)               \
  template void Solver<D>::begin_step(); \
  template void Solver<D>::place_grid(); \
  template void Solver<D>::clear(Grid<D>&);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
