// A prescribed velocity: linear between given times, so that ramps have no jump; held after the last.
#pragma once

#include <vector>

#include "tools/mpm/tensors.hpp"

namespace mpm {

template <int D>
struct VelocityHistory {
  std::vector<double> times;       ///< s, rising, the first is 0
  std::vector<Vec<D>> velocities;  ///< m/s; none: at rest

  Vec<D> at(double time) const {
    if (times.empty()) return Vec<D>::Zero();
    for (std::size_t k = 1; k < times.size(); ++k) {
      if (time >= times[k]) continue;
      const double part = (time - times[k - 1]) / (times[k] - times[k - 1]);
      return velocities[k - 1] + part * (velocities[k] - velocities[k - 1]);
    }
    return velocities.back();
  }
  /// Way since time 0, m: the exact integral.
  Vec<D> way(double time) const {
    Vec<D> sum = Vec<D>::Zero();
    for (std::size_t k = 1; k < times.size() && times[k - 1] < time; ++k) {
      const double end = std::min(time, times[k]);
      sum += 0.5 * (end - times[k - 1]) * (velocities[k - 1] + at_of(k, end));
    }
    if (!times.empty() && time > times.back()) sum += (time - times.back()) * velocities.back();
    return sum;
  }

 private:
  Vec<D> at_of(std::size_t k, double time) const {
    const double part = (time - times[k - 1]) / (times[k] - times[k - 1]);
    return velocities[k - 1] + part * (velocities[k] - velocities[k - 1]);
  }
};

}  // namespace mpm
