// Letting go of what an assembly can make again, and making it again.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab {

/// Lets go of the working arrays; only wake, close and memory_of may be called then.
void rest(Assembly& assembly);

/// Makes them again: the bits are those before resting.
void wake(const Fixture& fixture, Assembly& assembly);

Memory memory_of(const Assembly& assembly);

}  // namespace rvelab
