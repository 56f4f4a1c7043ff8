// Scalar kernels of ellipses: the reference that every vector path equals bitwise, the one with the energy balance,
// and the evaluation of the stored history on opening.
//
// Declared in instruction_sets.hpp.
#include "rvelab/solver/kernels/instruction_sets.hpp"
#include "rvelab/solver/kernels/table.hpp"

namespace rvelab {

void set_ellipse_kernels_scalar(const KernelConfiguration& key, const char* instruction_set, Kernels& kernels) {
  set_kernels<Shape::ellipse, 1>(key, instruction_set, kernels);
}

void set_ellipse_kernels_shared(const KernelConfiguration& key, Kernels& kernels) {
  kernels.pairs_with_losses = pair_kernel_for<Shape::ellipse, 1, true>(key);
  kernels.evaluate = pair_kernel_for<Shape::ellipse, 1, false>(key);
}

}  // namespace rvelab
