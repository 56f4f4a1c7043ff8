// Step kernels of ellipses, for one instruction set or the scalar reference (step_kernels.hpp).
//
// Declared in instruction_sets.hpp.
#include "rvelab/solver/kernels/ellipses.hpp"
#include "rvelab/solver/kernels/instruction_sets.hpp"
#include "rvelab/solver/kernels/step_kernels.hpp"

namespace rvelab {

template <>
void StepKernels<Shape::ellipse>::RVELAB_ISA(const KernelConfiguration& key, Kernels& kernels) {
  set_kernels<Ellipses, RVELAB_LANES>(key, kernels);
  kernels.places = &ellipse_pair_places<RVELAB_LANES>;
}

}  // namespace rvelab
