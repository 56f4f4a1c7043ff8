// Buffers that an assembly can make again: released while an RVE waits, allocated again for the next call.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/loading/report.hpp"

namespace rvelab {

/// The grain rows keep the masses for as long as the working arrays are released.
void put_masses_into_rows(const Model& model, Assembly& assembly);
/// Frees the working arrays; only rebuild_buffers, close_assembly and memory_of may be called then.
void release_buffers(Assembly& assembly);

/// Makes them again: the bits are those before. Throws std::bad_alloc; the assembly has none of them then.
void rebuild_buffers(const Model& model, Assembly& assembly);

Memory memory_of(const Assembly& assembly);

}  // namespace rvelab
