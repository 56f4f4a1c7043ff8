// When a point of the soil touches the surface of a body, and near which node.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/mpm/grid/grid.hpp"
#include "tools/mpm/grid/point.hpp"
#include "tools/mpm/grid/shape.hpp"

namespace mpm {

// Cells from the surface within which a domain touches it: straining moves a point against its domain by so much.
inline constexpr double early = 0.1;

/// The number of the node nearest to a place, which may lie outside the box of the grid.
template <int D>
inline typename Grid<D>::Index rounded(const Grid<D>& grid, const Vec<D>& at) {
  typename Grid<D>::Index node;
  for (int i = 0; i < D; ++i) node[i] = int(floor_of((at[i] - grid.anchor[i]) / grid.cell[i] + 0.5));
  return node;
}

/// False outside the box of the grid.
template <int D>
inline bool nearest_node(const Grid<D>& grid, const Vec<D>& at, typename Grid<D>::Index& node) {
  for (int i = 0; i < D; ++i) {
    const double xi = (at[i] - grid.anchor[i]) / grid.cell[i] + 0.5;
    if (!(xi >= grid.low[i] && xi < grid.low[i] + grid.count[i])) return false;
  }
  node = rounded(grid, at);
  return true;
}

/// m, half sides of a point's domain: of its first form and the size that its volume tells.
template <int D>
inline Vec<D> half_size(const Point<D>& point) {
  const double swollen = D == 2 ? std::sqrt(point.F.determinant()) : std::cbrt(point.F.determinant());
  return swollen * point.half;
}

/// Numbers of points by the cell that they are in, in their order.
template <int D>
class PointsByCell {
 public:
  PointsByCell(const Grid<D>& grid, const std::vector<Point<D>>& points) : grid_(grid) {
    begin_.assign(grid.nodes.size() + 1, 0);
    numbers_.resize(points.size());
    std::vector<long> cells(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      cells[k] = grid.flat(cell_of(points[k].position));
      ++begin_[std::size_t(cells[k]) + 1];
    }
    for (std::size_t n = 1; n < begin_.size(); ++n) begin_[n] += begin_[n - 1];
    auto next = begin_;
    for (std::size_t k = 0; k < points.size(); ++k) numbers_[std::size_t(next[std::size_t(cells[k])]++)] = long(k);
  }
  /// Numbers in the order of the cells.
  const std::vector<long>& numbers() const { return numbers_; }
  /// visit(number) for the points in all cells that a box about a place, of this half side (m), reaches.
  template <class Visit>
  void each_near(const Vec<D>& centre, double half, const Visit& visit) const {
    each_entry_near(centre, half, [&](long k) { visit(numbers_[std::size_t(k)]); });
  }
  /// The same with where the point stands in numbers().
  template <class Visit>
  void each_entry_near(const Vec<D>& centre, double half, const Visit& visit) const {
    const auto first = cell_of(centre.array() - half), last = cell_of(centre.array() + half);
    auto cell = first;
    while (true) {
      const auto flat = std::size_t(grid_.flat(cell));
      for (long k = begin_[flat]; k < begin_[flat + 1]; ++k) visit(k);
      int axis = 0;
      while (axis < D && ++cell[axis] > last[axis]) cell[axis] = first[axis], ++axis;
      if (axis == D) return;
    }
  }

 private:
  typename Grid<D>::Index cell_of(const Vec<D>& at) const {
    typename Grid<D>::Index cell;
    for (int i = 0; i < D; ++i) {
      const double number = floor_of((at[i] - grid_.anchor[i]) / grid_.cell[i]);
      cell[i] = int(std::clamp<double>(number, grid_.low[i], grid_.low[i] + grid_.count[i] - 1));
    }
    return cell;
  }
  const Grid<D>& grid_;
  std::vector<long> begin_, numbers_;
};

}  // namespace mpm
