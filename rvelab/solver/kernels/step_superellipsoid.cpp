// Step kernels of superellipsoids, for one instruction set or the scalar reference (step_kernels.hpp).
//
// Declared in instruction_sets.hpp.
#include "rvelab/solver/kernels/instruction_sets.hpp"
#include "rvelab/solver/kernels/step_kernels.hpp"
#include "rvelab/solver/kernels/superellipsoids.hpp"

namespace rvelab {

template <>
void StepKernels<Shape::superellipsoid>::RVELAB_ISA([[maybe_unused]] const KernelConfiguration& key,
                                                    [[maybe_unused]] Kernels& kernels) {
#ifndef RVELAB_FEWER_KERNELS
  const bool curvature = key.hertz_radius == HertzRadius::curvature;
  set_kernels<SuperellipsoidPairs, RVELAB_LANES>(key, kernels);
  if (key.ellipsoids)
    kernels.places = curvature ? &superellipsoid_pair_places<RVELAB_LANES, true, true>
                               : &superellipsoid_pair_places<RVELAB_LANES, true, false>;
  else
    kernels.places = curvature ? &superellipsoid_pair_places<RVELAB_LANES, false, true>
                               : &superellipsoid_pair_places<RVELAB_LANES, false, false>;
#endif
}

}  // namespace rvelab
