// What a search that found no specimen reports: what was reached, and the remedy.
#pragma once

#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/pack/draw.hpp"

namespace rvelab::pack {

/// Why a search ends without a specimen.
enum class End { draws_spent, out_of_reach, contacts_out_of_reach };

/// Void ratios this near to the target are about it.
double near_density(const Recipe& recipe);

/// The range that the draws reached, and what to do about a target that is out of it; `failed`: draws beside these that
/// gave no packing.
Error not_found(const Recipe& recipe, const std::vector<Draw>& draws, std::size_t failed, End end);

}  // namespace rvelab::pack
