// Increments that are resolved so finely that their own error is far below any tolerance.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/specimens.hpp"

namespace rvelab::test {

inline const Matrix3 biaxial_step = gradient(0.45, 0, 0, -0.9), shear_step = gradient(0.3, 0.6, 0, -0.3);

inline Matrix3 resolved_stress(Specimen s, const Matrix3& increment, long substeps = 4000) {
  s.solver.fixed_substeps = substeps;
  Rve rve(s);
  rve.apply(increment, 0);
  rve.relax(1e-7, 100'000);
  return rve.stress();
}

/// An increment to the tolerances of the specimen, and how far its stress is from the resolved one.
struct Judged {
  Report report;
  double error = 0;  ///< Pa
  bool within_estimate() const { return error <= report.error_estimate; }
};

inline Judged judged(const Specimen& s, const Matrix3& increment) {
  Rve rve(s);
  const Response response = rve.apply(increment, 0);
  return {response.report, (response.stress - resolved_stress(s, increment)).norm()};
}

/// Errors of many increments over what they may be. A packing is chaotic: a single one says little, and counts of them
/// change with the last bit of a program.
struct Ratios : std::vector<double> {
  double largest() const { return *std::max_element(begin(), end()); }
  double root_mean_square() const {
    return std::sqrt(std::inner_product(begin(), end(), begin(), 0.0) / double(size()));
  }
  double share_below_one() const {
    return double(std::count_if(begin(), end(), [](double ratio) { return ratio <= 1; })) / double(size());
  }
};

}  // namespace rvelab::test
