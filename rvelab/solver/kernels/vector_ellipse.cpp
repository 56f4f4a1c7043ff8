// Step kernels of ellipses for one instruction set; the build compiles this file once per set, with RVELAB_ISA its
// name and RVELAB_LANES its lanes. Nothing here may leave a weak symbol: a linker could pick the copy of a wider set.
//
// Declared in instruction_sets.hpp.
#include "rvelab/solver/kernels/instruction_sets.hpp"
#include "rvelab/solver/kernels/table.hpp"

#define RVELAB_JOIN_(a, b) a##b
#define RVELAB_JOIN(a, b) RVELAB_JOIN_(a, b)

namespace rvelab {

void RVELAB_JOIN(set_ellipse_kernels_, RVELAB_ISA)(const KernelConfiguration& key, const char* instruction_set,
                                                   Kernels& kernels) {
  set_kernels<Shape::ellipse, RVELAB_LANES>(key, instruction_set, kernels);
}

}  // namespace rvelab
