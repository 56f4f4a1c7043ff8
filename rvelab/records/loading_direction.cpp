#include "rvelab/records/loading_direction.hpp"

#include <Eigen/LU>
#include <cmath>

namespace rvelab::records {

Matrix3 loading_direction(std::span<const Record> records) {
  constexpr double window = 0.005;
  if (records.size() < 2) return Matrix3::Zero();
  const Record& last = records.back();
  const double sign = last.strain - records[records.size() - 2].strain;
  std::size_t first = records.size() - 1;
  while (first > 0 && records[first - 1].stage == last.stage &&
         std::abs(last.strain - records[first].strain) < window * (1 - 1e-9) &&
         (records[first].strain - records[first - 1].strain) * sign > 0)
    --first;
  const Matrix3 &from = records[first].deformation_gradient, &to = last.deformation_gradient;
  const Matrix3 l = (to - from) * (0.5 * (from + to)).inverse();
  return 0.5 * (l + l.transpose());
}

}  // namespace rvelab::records
