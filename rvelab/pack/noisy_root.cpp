#include "rvelab/pack/noisy_root.hpp"

#include <algorithm>
#include <cmath>

namespace rvelab::pack {

namespace {

/// Longest step from the points known, in scatters over the slope; the slope is within this factor of that of the
/// start.
constexpr double longest_step = 24, slope_factor = 4;
/// Weight of the slope of the start: as of two points this many scatters apart.
constexpr double weight_of_start = 8;

}  // namespace

NoisyRoot::NoisyRoot(double low, double high, double start, double slope, double scatter)
    : low_(low), high_(high), start_(std::clamp(start, low, high)), slope_(slope), scatter_(scatter) {}

void NoisyRoot::add(double at, double value) { points_.push_back({at, value}); }

double NoisyRoot::next() const {
  if (points_.empty()) return start_;
  const auto weight_of = [&](const Point& point) {
    const double far = point.value / (4 * scatter_);
    return 1 / ((1 + far * far) * (1 + far * far));
  };
  double weights = 0, at = 0, value = 0;
  for (const Point& point : points_) {
    const double weight = weight_of(point);
    weights += weight;
    at += weight * point.at;
    value += weight * point.value;
  }
  at /= weights;
  value /= weights;
  // Of the slope, in units in which that of the start is 1.
  double squares = std::pow(weight_of_start * scatter_ / slope_, 2) / 2, products = squares * slope_;
  for (const Point& point : points_) {
    const double weight = weight_of(point);
    squares += weight * (point.at - at) * (point.at - at);
    products += weight * (point.at - at) * (point.value - value);
  }
  const double slope = slope_ * std::clamp(products / squares / slope_, 1 / slope_factor, slope_factor);
  const double reach = longest_step * scatter_ / std::abs(slope_);
  return std::clamp(at + std::clamp(-value / slope, -reach, reach), low_, high_);
}

bool NoisyRoot::out_of_range() const {
  int low = 0, high = 0;
  for (const Point& point : points_) {
    const double beyond = -point.value / slope_;
    if (point.at == low_ && beyond < 0) ++low;
    if (point.at == high_ && beyond > 0) ++high;
  }
  return low >= 2 || high >= 2;
}

}  // namespace rvelab::pack
