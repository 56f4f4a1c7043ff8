// What the rows of superellipsoids hold beside motion (grains/superellipsoid.hpp).
#pragma once

#include <vector>

#include "rvelab/grains/rigid_motion.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// Columns 3 and 16 to 23 of each grain, nine each.
std::vector<double> forms_of(const Grains& grains);
/// Of one grain.
std::vector<double> form_of_grain(const Grains& grains, std::size_t g);
/// Whether the grains are superellipsoids with exponents of 2: then formulas without powers serve.
bool all_ellipsoids(const Grains& grains);

inline void put_orientation(const Turn& q, double* row) {
  row[12] = q.w;
  for (int k = 0; k < 3; ++k) row[13 + k] = q.v[k];
}

}  // namespace rvelab
