// Whether what interactions form from lies where their tables and formulas hold. Beyond it they still give a value:
// that of the nearest shape in the table, or of a formula that no longer describes the grains.
#pragma once

#include <string>
#include <vector>

#include "rvelab/interaction/dmt.hpp"
#include "rvelab/interaction/jkr.hpp"
#include "rvelab/interaction/water.hpp"

namespace rvelab {

/// A line for each range that is left, with the key, its value, the range and a remedy; empty where all hold. `pairs`
/// have an interaction, or would get one; at least one.
std::vector<std::string> outside_ranges(const Water& water, const std::vector<GrainPair>& pairs, double pore_volume);
std::vector<std::string> outside_ranges(const SurfaceEnergy& surface, const std::vector<GrainPair>& pairs, double);
std::vector<std::string> outside_ranges(const VanDerWaals& surface, const std::vector<GrainPair>& pairs, double);
/// Of a law whose formula holds everywhere.
template <class Settings>
std::vector<std::string> outside_ranges(const Settings&, const std::vector<GrainPair>&, double) {
  return {};
}

}  // namespace rvelab
