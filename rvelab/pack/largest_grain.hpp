// Whether one grain is too large for a specimen: beside the mass of all grains, and beside the periodic cell.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::pack {

/// Above a twentieth of the mass no mean over many grains is left; below three of its diameters the largest grain lies
/// nearly beside its own image.
inline constexpr double usual_mass_share = 0.05, usual_cell_widths = 3;

/// Radius (m, of the disc or sphere of the same area or volume) and mass (kg) of each grain; of clumps those of the
/// bodies.
std::vector<std::pair<double, double>> radii_and_masses(const Specimen& specimen);

/// The largest grain, by the diameter of the disc or sphere of the same area or volume.
struct LargestGrain {
  double mass_share = 0;   ///< of all grains, of the heaviest
  double cell_widths = 0;  ///< smallest height of the cell over the diameter
  /// Numbers of grains of these sizes, or of the grading, with which the two are usual: a share goes with 1/N, a width
  /// with N^(1/d).
  double number_by_share = 0, number_by_widths = 0;
  bool is_usual() const { return mass_share <= usual_mass_share && cell_widths >= usual_cell_widths; }
};

LargestGrain largest_grain(const Specimen& specimen);

/// What is unusual, and how many grains it takes: "the largest grain has 21 % of the mass; usual: up to 5 %, which
/// takes 9850 grains of this grading; the cell is ...". "" where all is usual. `grains`: "of this grading".
std::string unusual_in_words(const LargestGrain& largest, const std::string& grains);

}  // namespace rvelab::pack
