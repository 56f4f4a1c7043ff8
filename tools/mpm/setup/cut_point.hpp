// Points at the edge of what stands in the soil.
#pragma once

#include <cmath>

#include "tools/mpm/grid/point.hpp"

namespace mpm {

/// The part of a point's domain where inside(position) is not true, by 6 positions along each axis: the point becomes
/// that part, at its centre of mass. False: there is less than a twentieth, or its centre lies inside (soil around a
/// cap).
template <int D, class Inside>
bool cut_point(Point<D>& point, const Inside& inside) {
  constexpr int along = 6;
  Vec<D> sum = Vec<D>::Zero();
  long outside = 0, all = 1;
  for (int i = 0; i < D; ++i) all *= along;
  for (long k = 0; k < all; ++k) {
    Vec<D> position = point.position;
    long rest = k;
    for (int i = 0; i < D; ++i, rest /= along) {
      position[i] += (double(rest % along) + 0.5 - 0.5 * along) * 2 / along * point.half[i];
    }
    if (inside(position)) continue;
    sum += position;
    ++outside;
  }
  if (outside == all) return true;
  if (20 * outside < all) return false;
  const Vec<D> centre = sum / double(outside);
  if (inside(centre)) return false;
  const double part = double(outside) / double(all);
  point.position = point.first = centre;
  point.volume *= part;
  point.half *= std::pow(part, 1.0 / D);
  return true;
}

}  // namespace mpm
