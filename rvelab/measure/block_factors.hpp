// LU factors of a sparse matrix of square blocks, a row and a column of blocks for each grain and a pair of blocks for
// each contact. Grains are eliminated in the order of least degree (Rose 1972): the next is the remaining grain with
// the fewest neighbours, which then become neighbours of each other. Rows are exchanged only within a block: the
// stiffness of a network is nearly symmetric, and iterative refinement corrects the loss at poor pivots.
//
// Out of memory throws std::bad_alloc. (Eigen's SparseLU frees memory twice after a failed reallocation.)
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace rvelab {

/// `F`: rows of a block. Zero until blocks are added to.
template <int F>
class BlockFactors {
 public:
  using Block = Eigen::Matrix<double, F, F>;

  BlockFactors() = default;
  /// Blocks of `grains` rows; those beside the diagonal are of these pairs, in either order, possibly repeated.
  BlockFactors(std::size_t grains, std::span<const std::array<int, 2>> pairs) {
    const auto later = order_of(neighbours_of(grains, pairs));
    begin_.push_back(0);
    for (const std::vector<int>& positions : later) {
      later_.insert(later_.end(), positions.begin(), positions.end());
      begin_.push_back(later_.size());
    }
    diagonal_.assign(grains, Block::Zero());
    lower_.assign(later_.size(), Block::Zero());
    upper_.assign(later_.size(), Block::Zero());
  }

  /// Block of the grains i (row) and j (column).
  Block& at(int i, int j) {
    const int row = position_[std::size_t(i)], column = position_[std::size_t(j)];
    if (row == column) return diagonal_[std::size_t(row)];
    return row > column ? lower_[find(column, row)] : upper_[find(row, column)];
  }

  /// Largest absolute value on the diagonal.
  double largest_on_diagonal() const {
    double largest = 0;
    for (const Block& block : diagonal_) largest = std::max(largest, block.diagonal().cwiseAbs().maxCoeff());
    return largest;
  }
  void add_to_diagonal(double value) {
    for (Block& block : diagonal_) block.diagonal().array() += value;
  }

  /// False: a block of the diagonal has no finite inverse.
  bool factorise() {
    for (std::size_t k = 0; k < diagonal_.size(); ++k) {
      const Block inverse = diagonal_[k].partialPivLu().inverse();
      if (!inverse.allFinite()) return false;
      diagonal_[k] = inverse;
      const std::size_t end = begin_[k + 1];
      for (std::size_t q = begin_[k]; q < end; ++q) lower_[q] = (lower_[q] * inverse).eval();
      for (std::size_t q = begin_[k]; q < end; ++q) {
        const auto row = std::size_t(later_[q]);
        diagonal_[row].noalias() -= lower_[q] * upper_[q];
        std::size_t at = begin_[row];
        for (std::size_t r = q + 1; r < end; ++r, ++at) {
          while (later_[at] != later_[r]) ++at;
          upper_[at].noalias() -= lower_[q] * upper_[r];
          lower_[at].noalias() -= lower_[r] * upper_[q];
        }
      }
    }
    return true;
  }

  /// Solves in place for the right-hand side `x`, F numbers for each grain; `scratch` has the same length.
  void solve(Eigen::VectorXd& x, Eigen::VectorXd& scratch) const {
    for (std::size_t g = 0; g < position_.size(); ++g) part(scratch, std::size_t(position_[g])) = part(x, g);
    for (std::size_t k = 0; k < diagonal_.size(); ++k)
      for (std::size_t q = begin_[k]; q < begin_[k + 1]; ++q)
        part(scratch, std::size_t(later_[q])).noalias() -= lower_[q] * part(scratch, k);
    for (std::size_t k = diagonal_.size(); k-- > 0;) {
      for (std::size_t q = begin_[k]; q < begin_[k + 1]; ++q)
        part(scratch, k).noalias() -= upper_[q] * part(scratch, std::size_t(later_[q]));
      part(scratch, k) = (diagonal_[k] * part(scratch, k)).eval();
    }
    for (std::size_t g = 0; g < position_.size(); ++g) part(x, g) = part(scratch, std::size_t(position_[g]));
  }

 private:
  static auto part(Eigen::VectorXd& x, std::size_t k) { return x.segment<F>(Eigen::Index(F * k)); }

  using Neighbours = std::vector<std::vector<int>>;  ///< of each grain, ascending

  static Neighbours neighbours_of(std::size_t grains, std::span<const std::array<int, 2>> pairs) {
    Neighbours found(grains);
    for (const auto& [i, j] : pairs) {
      if (i == j) continue;
      found[std::size_t(i)].push_back(j);
      found[std::size_t(j)].push_back(i);
    }
    for (std::vector<int>& of : found) {
      std::sort(of.begin(), of.end());
      of.erase(std::unique(of.begin(), of.end()), of.end());
    }
    return found;
  }

  /// Sets position_; returns for each position the later ones that are neighbours at its elimination, ascending.
  Neighbours order_of(Neighbours neighbours) {
    std::set<std::pair<std::size_t, int>> left;  // by degree, then by number
    for (std::size_t g = 0; g < neighbours.size(); ++g) left.emplace(neighbours[g].size(), int(g));
    position_.resize(neighbours.size());
    Neighbours later(neighbours.size());
    std::vector<int> joined;
    for (std::size_t k = 0; k < later.size(); ++k) {
      const int next = left.begin()->second;
      left.erase(left.begin());
      position_[std::size_t(next)] = int(k);
      later[k] = std::move(neighbours[std::size_t(next)]);
      for (const int g : later[k]) {
        std::vector<int>& of = neighbours[std::size_t(g)];
        left.erase({of.size(), g});
        joined.clear();
        std::set_union(of.begin(), of.end(), later[k].begin(), later[k].end(), std::back_inserter(joined));
        std::erase_if(joined, [&](int other) { return other == g || other == next; });
        of = joined;
        left.emplace(of.size(), g);
      }
    }
    for (std::vector<int>& of : later) {
      for (int& g : of) g = position_[std::size_t(g)];
      std::sort(of.begin(), of.end());
    }
    return later;
  }

  std::size_t find(int position, int after) const {
    const auto first = later_.begin() + std::ptrdiff_t(begin_[std::size_t(position)]);
    const auto last = later_.begin() + std::ptrdiff_t(begin_[std::size_t(position) + 1]);
    return std::size_t(std::lower_bound(first, last, after) - later_.begin());
  }

  std::vector<int> position_;       ///< of each grain in the order of elimination
  std::vector<std::size_t> begin_;  ///< first entry of each position in the arrays below, and their end
  std::vector<int> later_;          ///< positions of the blocks right of and below each diagonal block
  std::vector<Block> lower_, upper_;
  std::vector<Block> diagonal_;  ///< inverted by factorise()
};

}  // namespace rvelab
