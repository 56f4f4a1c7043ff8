// All pairs within reach by looking at every image that can be there: what list_pairs must equal.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "rvelab/solver/assembly/neighbour_list.hpp"

namespace rvelab::test {

/// Pairs with |x_j + L n - x_i| < r_i + r_j + skin, i < j or i == j with n forward, ordered. The images looked at are
/// those within reach of any two grains: |n_k| <= (reach + |x_j - x_i|) / height_k.
inline std::vector<ListedPair> brute_force_pairs(const Cell& cell, const std::vector<Vector3>& positions,
                                                 const std::vector<double>& radii, double skin) {
  std::vector<ListedPair> pairs;
  const Matrix3 inverse = cell.lattice.inverse();
  const int n = int(radii.size());
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) {
      const Vector3 gap = positions[std::size_t(j)] - positions[std::size_t(i)];
      const double reach = radii[std::size_t(i)] + radii[std::size_t(j)] + skin;
      int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
      for (int k = 0; k < cell.dimension; ++k) {
        // n = L^-1 (b - gap) with |b| < reach.
        const double middle = -inverse.row(k).dot(gap), width = inverse.row(k).norm() * reach;
        low[k] = int(std::floor(middle - width)) - 1;
        high[k] = int(std::ceil(middle + width)) + 1;
      }
      for (int a = low[0]; a <= high[0]; ++a)
        for (int b = low[1]; b <= high[1]; ++b)
          for (int c = low[2]; c <= high[2]; ++c) {
            if (i == j && !(a > 0 || (a == 0 && (b > 0 || (b == 0 && c > 0))))) continue;
            if ((gap + cell.lattice * Vector3(a, b, c)).norm() < reach) pairs.push_back({i, j, {a, b, c}});
          }
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

inline std::vector<ListedPair> listed_pairs(const Cell& cell, const std::vector<Vector3>& positions,
                                            const std::vector<double>& radii, double skin) {
  std::vector<double> rows;
  for (const Vector3& x : positions) rows.insert(rows.end(), {x[0], x[1], x[2], -7.0, 1e300});
  return list_pairs(cell, rows.data(), 5, radii, skin);
}

}  // namespace rvelab::test
