// Discs (description.hpp).
#pragma once

#include "rvelab/grains/description.hpp"

namespace rvelab {

struct Disc : RoundGrain<Disc> {
  static constexpr const char* name = "disc";
  static constexpr int dimension = 2;
  static constexpr bool pairs_hold_radii = true, fills_rows = true;

  static constexpr int row_length = 8, released_mass = 5, released_inverse_inertia = 6;
  static void complete_row(double, double* row) { row[5] = row[6] = 0; }

  static constexpr double inertia(double mass, double radius, const Columns<One>&) {
    return 0.5 * mass * radius * radius;
  }
};

}  // namespace rvelab
