// What a scene prescribes over time: velocities, and numbers such as pressures.
#pragma once

#include <algorithm>
#include <vector>

#include "tools/mpm/tensors.hpp"

namespace mpm {

/// A prescribed velocity: linear between given times, so that ramps have no jump; held after the last.
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
  /// Displacement since time 0, m: the exact integral.
  Vec<D> displacement(double time) const {
    Vec<D> sum = Vec<D>::Zero();
    for (std::size_t k = 1; k < times.size() && times[k - 1] < time; ++k) {
      const double end = std::min(time, times[k]);
      sum += 0.5 * (end - times[k - 1]) * (velocities[k - 1] + at_of(k, end));
    }
    if (!times.empty() && time > times.back()) sum += (time - times.back()) * velocities.back();
    return sum;
  }
  /// The least displacement along an axis up to a time: at its ends, or where the velocity along it changes sign.
  double least_displacement(int axis, double until) const {
    double least = std::min(0.0, displacement(until)[axis]);
    for (std::size_t k = 0; k < times.size() && times[k] < until; ++k) {
      least = std::min(least, displacement(times[k])[axis]);
      if (k == 0) continue;
      const double before = velocities[k - 1][axis], after = velocities[k][axis];
      if (!(before < 0 && after > 0)) continue;
      const double turn = times[k - 1] + (times[k] - times[k - 1]) * before / (before - after);
      least = std::min(least, displacement(turn)[axis]);
    }
    return least;
  }

 private:
  Vec<D> at_of(std::size_t k, double time) const {
    const double part = (time - times[k - 1]) / (times[k] - times[k - 1]);
    return velocities[k - 1] + part * (velocities[k] - velocities[k - 1]);
  }
};

/// Values at times, linear between them; before the first and after the last, as there.
struct TimeHistory {
  std::vector<double> times, values;

  double at(double time) const {
    if (times.empty()) return 0;
    const auto next = std::upper_bound(times.begin(), times.end(), time) - times.begin();
    if (next == 0) return values.front();
    if (next == long(times.size())) return values.back();
    const double part = (time - times[next - 1]) / (times[next] - times[next - 1]);
    return values[next - 1] + part * (values[next] - values[next - 1]);
  }
};

}  // namespace mpm
