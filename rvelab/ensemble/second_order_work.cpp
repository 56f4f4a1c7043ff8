#include "rvelab/ensemble/second_order_work.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/ensemble/statistics.hpp"

namespace rvelab::ensemble {
namespace {

struct Increment {
  double work = 0, normalised = 0;
};

Increment increment_between(const records::Record& from, const records::Record& to) {
  const Matrix3 middle = 0.5 * (from.deformation_gradient + to.deformation_gradient);
  const Matrix3 l = (to.deformation_gradient - from.deformation_gradient) * middle.inverse();
  const Matrix3 strain = 0.5 * (l + l.transpose()), spin = 0.5 * (l - l.transpose());
  const Matrix3 mean = 0.5 * (from.stress + to.stress);
  const Matrix3 whole = to.stress - from.stress - spin * mean + mean * spin;
  const Matrix3 stress = 0.5 * (whole + whole.transpose());
  const double work = stress.cwiseProduct(strain).sum(), size = stress.norm() * strain.norm();
  return {work, size > 0 ? work / size : 0};
}

template <class Value>
std::vector<double> of_increments(std::span<const records::Record> records, const Value& value) {
  std::vector<double> all(records.size(), 0);
  for (std::size_t k = 1; k < records.size(); ++k)
    if (records[k].stage == records[k - 1].stage) all[k] = value(increment_between(records[k - 1], records[k]));
  return all;
}

}  // namespace

std::vector<double> second_order_work(std::span<const records::Record> records) {
  return of_increments(records, [](const Increment& increment) { return increment.work; });
}

std::vector<double> normalised_second_order_work(std::span<const records::Record> records) {
  return of_increments(records, [](const Increment& increment) { return increment.normalised; });
}

Instability instability_of(std::span<const records::Record> stage, double window) {
  Instability found{nan, nan};
  std::size_t last = 0;
  for (std::size_t first = 0; first < stage.size(); ++first) {
    while (last < stage.size() && std::abs(stage[last].strain - stage[first].strain) < window * (1 - 1e-9)) ++last;
    if (last >= stage.size()) break;
    if (last < first + 2) continue;
    const double work = increment_between(stage[first], stage[last]).normalised;
    found.least = std::isnan(found.least) ? work : std::min(found.least, work);
    if (work < 0 && std::isnan(found.strain)) found.strain = 0.5 * (stage[first].strain + stage[last].strain);
  }
  return found;
}

}  // namespace rvelab::ensemble
