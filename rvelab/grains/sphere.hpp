// Spheres (description.hpp).
#pragma once

#include "rvelab/grains/description.hpp"

namespace rvelab {

struct Sphere : RoundGrain<Sphere> {
  static constexpr const char* name = "sphere";
  static constexpr int dimension = 3;
  static constexpr bool pairs_hold_radii = false, fills_rows = false;

  static constexpr int row_length = 12, released_mass = 7, released_inverse_inertia = 11;
  static void complete_row(double radius, double* row) {
    row[3] = row[11] = radius;
    row[7] = 0;
  }

  static constexpr double inertia(double mass, double radius, const Columns<One>&) {
    return 0.4 * mass * radius * radius;
  }
};

}  // namespace rvelab
