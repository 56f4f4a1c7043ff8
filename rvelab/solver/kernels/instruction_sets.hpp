// The functions that fill in the kernels of a configuration, one for each instruction set and shape. A build defines
// those that its compiler can make.
#pragma once

#include "rvelab/solver/kernels/configuration.hpp"

namespace rvelab {

#define RVELAB_DECLARE(isa)                                                          \
  void set_disc_kernels_##isa(const KernelConfiguration&, const char*, Kernels&);    \
  void set_ellipse_kernels_##isa(const KernelConfiguration&, const char*, Kernels&); \
  void set_sphere_kernels_##isa(const KernelConfiguration&, const char*, Kernels&)
RVELAB_DECLARE(scalar);
RVELAB_DECLARE(baseline);
RVELAB_DECLARE(v3);
RVELAB_DECLARE(v4);
#undef RVELAB_DECLARE

/// Scalar on every machine: the pair loop with losses, and the evaluation of stored histories.
void set_disc_kernels_shared(const KernelConfiguration&, Kernels&);
void set_ellipse_kernels_shared(const KernelConfiguration&, Kernels&);
void set_sphere_kernels_shared(const KernelConfiguration&, Kernels&);

}  // namespace rvelab
