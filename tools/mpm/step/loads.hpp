// Loads that change with time: shaking in the frame of the box, pressure on strips of the surface.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "tools/mpm/bodies/histories.hpp"

namespace mpm {

/// The box moves along one axis and the scene is seen from it: exact as a body force, -a(t) on all mass. Harmonic, v =
/// V sin(2 pi f t), or a record of accelerations, which ends at rest.
struct Shaking {
  int axis = 0;
  double velocity = 0, frequency = 0;  ///< m/s, Hz
  TimeHistory record;                  ///< s, m/s^2

  double acceleration(double time) const {
    if (!record.times.empty()) return time > record.times.back() ? 0 : record.at(time);
    const double omega = 2 * std::numbers::pi * frequency;
    return velocity * omega * std::cos(omega * time);
  }
  bool any() const { return velocity != 0 || !record.times.empty(); }
};

/// Pressure (Pa) on the free surface above lower < x < upper (m): a uniform stress along the last axis in all soil
/// below, of which only the changes along that axis act; the base takes it.
struct Strip {
  double lower = 0, upper = 0;
  TimeHistory history;
  double peak = 0, duration = 0;  ///< beside the history: half a sine (Pa, s)

  double pressure(double time) const {
    const double pulse = time < duration ? peak * std::sin(std::numbers::pi * time / duration) : 0;
    return history.at(time) + pulse;
  }
};

struct Loads {
  Shaking shaking;
  std::vector<Strip> strips;

  bool any() const { return shaking.any() || !strips.empty(); }
  double strip_pressure(double x, double time) const {
    double sum = 0;
    for (const auto& strip : strips) {
      if (x > strip.lower && x < strip.upper) sum += strip.pressure(time);
    }
    return sum;
  }
};

}  // namespace mpm
