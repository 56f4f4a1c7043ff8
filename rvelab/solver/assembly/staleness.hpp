// How long a list is good, and how wide the next one is. assembly.hpp declares what control asks of it.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

/// The skin of the next list, m, by counts alone: no clock decides what is computed.
double next_skin(const Model& model, const ListState& list);

/// What ListState::positions holds of a grain as it lies now.
Vector3 listed_place(const Model& model, const Assembly& assembly, std::size_t g);

}  // namespace rvelab
