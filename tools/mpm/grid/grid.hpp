// The background grid: a box of nodes that grows where the material goes. Nodes have global numbers, node 0 at the
// anchor, so that nothing that is computed depends on where the box ends.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>
#include <vector>

#include "tools/mpm/error.hpp"
#include "tools/mpm/tensors.hpp"

namespace mpm {

/// mass; v: momentum, then velocity at the start of the step; w: force, then velocity at its end; a: velocity mapped
/// from the points, then what the step added to it.
/// Vectors of space have a fourth entry, zero: registers hold two or four numbers, and sums over nodes are then made in
/// whole registers.
template <int D>
struct Node {
  static constexpr int lanes = D == 3 ? 4 : D;
  double v[lanes], w[lanes], a[lanes];
  double mass;
};

template <int D>
class Grid {
 public:
  using Index = std::array<int, D>;

  Vec<D> cell = Vec<D>::Ones();    ///< m, sides of a cell now
  Vec<D> anchor = Vec<D>::Zero();  ///< m, position of node 0
  std::vector<Node<D>> nodes;      ///< x fastest
  Index low{}, count = none();     ///< lowest node and number of nodes along each axis
  static constexpr long most = 40'000'000;
  /// As many as a box with so many points may have: one point that flies off must not fill the memory.
  static long most_for(long points) { return std::clamp(100 * points, most / 10, most); }

  /// Makes room for nodes from `first` to `last`; true if the box changed. InputError: more than `allowed`.
  bool cover(const Index& first, const Index& last, long allowed = most) {
    Index from = low, to;
    bool fits = true;
    for (int i = 0; i < D; ++i) {
      to[i] = low[i] + count[i] - 1;
      if (count[i] == 0) from[i] = first[i], to[i] = last[i];
      if (first[i] < from[i] || last[i] > to[i] || count[i] == 0) fits = false;
    }
    if (fits) return false;
    double size = 1;
    for (int i = 0; i < D; ++i) {
      if (count[i] == 0 || first[i] < from[i]) from[i] = first[i] - 4;
      if (count[i] == 0 || last[i] > to[i]) to[i] = last[i] + 4;
      size *= double(to[i]) - from[i] + 1;
    }
    if (size > double(allowed)) {
      std::ostringstream words;
      words << "the background grid would need " << size << " nodes, and has " << double(allowed)
            << " at most: a material point flies far off; take a smaller time.cfl, or add a boundary that holds it";
      throw InputError(words.str());
    }
    low = from;
    for (int i = 0; i < D; ++i) count[i] = to[i] - from[i] + 1;
    nodes.resize(std::size_t(size));
    return true;
  }
  /// Room for the box that `low` and `count` have from a checkpoint.
  void restore() {
    double size = 1;
    for (const int along : count) size *= double(along);
    if (*std::min_element(count.begin(), count.end()) < 0 || size > most)
      throw InputError("the checkpoint has a grid of no size; start the run again");
    nodes.resize(std::size_t(size));
  }
  /// Of nodes from..to - 1.
  void clear(long from, long to) {
    std::memset(static_cast<void*>(nodes.data() + from), 0, std::size_t(to - from) * sizeof(Node<D>));
  }
  bool contains(const Index& node) const {
    bool inside = true;
    for (int i = 0; i < D; ++i) inside = inside && node[i] >= low[i] && node[i] < low[i] + count[i];
    return inside;
  }
  long flat(const Index& node) const {
    long at = node[D - 1] - low[D - 1];
    for (int i = D - 2; i >= 0; --i) at = at * count[i] + (node[i] - low[i]);
    return at;
  }
  Index index(long flat) const {
    Index node;
    for (int i = 0; i < D; ++i) {
      node[i] = low[i] + int(flat % count[i]);
      flat /= count[i];
    }
    return node;
  }
  Vec<D> position(const Index& node) const {
    Vec<D> x;
    for (int i = 0; i < D; ++i) x[i] = anchor[i] + node[i] * cell[i];
    return x;
  }

 private:
  static constexpr Index none() { return Index{}; }
};

}  // namespace mpm
