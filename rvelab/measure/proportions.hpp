// Ratios that show whether the numbers of a specimen are plausible: they reveal a wrong unit, a thick slab or soft
// contacts.
#pragma once

#include <string>

#include "rvelab/solver/assembly/network.hpp"

namespace rvelab {

/// Dimensionless; NaN where the divisor is zero (no contact, no pressure).
struct Proportions {
  int dimension = 3;
  double void_ratio = 0;
  double mean_overlap = 0, largest_overlap = 0;  ///< over the smaller radius of the pair
  /// kn/(p d) in 3D, kn/(p thickness) in 2D, where a slab presses p d thickness through a contact: mean of the present
  /// normal stiffnesses over the mean pressure and the mean diameter. An overlap is about its inverse, over a diameter.
  double stiffness_level = 0;
  Vector3 cell_edges = Vector3::Zero();  ///< lengths of the cell vectors over the mean diameter; 2D: two
};

Proportions proportions_of(const Network& network);

/// On one line: "void ratio 0.187, overlap 0.0021 r (largest 0.0113 r), kn/(p t) 794, cell 21.3 x 21.0 diameters".
std::string in_words(const Proportions& proportions);

}  // namespace rvelab
