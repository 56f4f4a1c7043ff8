// Step kernels of bodies, for one instruction set or the scalar reference (step_kernels.hpp).
//
// Declared in instruction_sets.hpp.
#include "rvelab/solver/kernels/bodies.hpp"
#include "rvelab/solver/kernels/instruction_sets.hpp"

#ifndef RVELAB_ISA
#define RVELAB_ISA scalar
#define RVELAB_LANES 1
#endif

namespace rvelab {
namespace {

/// `By`: the shape, like Disc.
template <class By, int W>
void set_body_kernels(Kernels& kernels) {
  kernels.gather_on_members = &gather_on_members<By, W>;
  kernels.move_bodies[0] = &move_bodies<By, W, false>;
  kernels.move_bodies[1] = &move_bodies<By, W, true>;
  if constexpr (By::round) kernels.place_members = &place_members<W, By::dimension>;
}

}  // namespace

void BodyKernels::RVELAB_ISA(const KernelConfiguration& key, Kernels& kernels) {
  with_shape(key.shape, [&](auto is) {
    using By = typename decltype(is)::By;
#ifdef RVELAB_FEWER_KERNELS
    constexpr bool has_kernels = By::round;  // as step_kernels.hpp
#else
    constexpr bool has_kernels = By::round || By::rigid;
#endif
    if constexpr (has_kernels) set_body_kernels<By, RVELAB_LANES>(kernels);
  });
}

}  // namespace rvelab
