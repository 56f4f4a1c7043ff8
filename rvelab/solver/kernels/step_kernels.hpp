// Turns a configuration into compiled kernels: one switch per flag, each ending in a template argument.
//
// The build compiles step_SHAPE.cpp once for each instruction set, with RVELAB_ISA its name and RVELAB_LANES its lanes;
// nothing there may leave a weak symbol: a linker could pick the copy of a wider set. Compiled without them it is the
// scalar reference that every vector path equals bitwise.
#pragma once

#include <type_traits>

#include "rvelab/solver/kernels/integrate_discs.hpp"
#include "rvelab/solver/kernels/integrate_spheres.hpp"
#include "rvelab/solver/kernels/interaction_loops.hpp"
#include "rvelab/solver/kernels/plane.hpp"
#include "rvelab/solver/kernels/space.hpp"

#ifndef RVELAB_ISA
#define RVELAB_ISA scalar
#define RVELAB_LANES 1
#endif

namespace rvelab {
namespace {

template <class One, class... Several>
constexpr bool is_any_of = (std::is_same_v<One, Several> || ...);

/// A build whose weight counts (tools/cmake/wasm.cmake) has kernels of quasi-static loading of discs, ellipses and
/// spheres, linear and Hertzian, without dashpots and interactions. The rest is refused where its kernel is asked for.
#ifdef RVELAB_FEWER_KERNELS
constexpr bool fewer_kernels = true;
#else
constexpr bool fewer_kernels = false;
#endif
template <class Law>
constexpr bool has_kernels = !fewer_kernels || is_any_of<Law, LinearLaw, LinearStiffnessLaw, HertzMindlinLaw>;

/// `Pairs`: the geometry of a shape, like Discs.
template <class Pairs, class Law, class T>
constexpr PairKernel pair_kernel() {
  if constexpr (Pairs::By::dimension == 2)
    return &pair_loop<Pairs, T, PlaneUpdate<Pairs, Law, T>>;
  else
    return &pair_loop<Pairs, T, SpaceUpdate<Pairs, Law, T>>;
}

template <class Pairs, class T>
constexpr GrainKernel grain_kernel() {
  if constexpr (Pairs::By::dimension == 2)
    return &grain_loop<PlaneGrains<typename Pairs::Rows, T>>;
  else
    return &grain_loop<SphereGrains<T>>;
}

/// Which kernels there are in more than one lane; where there are none the scalar reference does the work (README.md
/// says for how much). The slip of other codes serves comparison, and no recipe gives the other laws to grains that are
/// not round; those that stiffen as sands do may be asked of superellipsoids.
template <class Pairs, class Force>
constexpr bool has_lanes = Pairs::By::round || is_any_of<Force, LinearForce, HertzMindlinForce> ||
                           (Pairs::By::rigid && is_any_of<Force, RoughForce, ConesForce>);

template <class Pairs, int W, bool Advance, class Law, bool Rolling, bool Dashpot>
PairKernel by_slip(const KernelConfiguration& key) {
  // In space a force row holds no moment: where nothing advances, rolling makes no difference.
  constexpr bool rolling = Rolling && (Advance || Pairs::By::dimension == 2);
  if constexpr (!Pairs::By::round) {
    if constexpr (Law::has_hertz_radius && Pairs::By::has_hertz_curvature) {
      constexpr auto curvature = HertzRadius::curvature;
      if (key.hertz_radius == curvature)
        return pair_kernel<Pairs, Law, PairTraits<W, rolling, false, Dashpot, Advance, curvature>>();
    }
  } else if (key.slip != Slip::consistent) {
    // Without motion there is no slip.
    if constexpr (W > 1 || fewer_kernels) return nullptr;
    if constexpr (W == 1 && !fewer_kernels && (Advance || Dashpot))
      return pair_kernel<Pairs, Law, PairTraits<W, rolling, true, Dashpot, Advance>>();
  }
  return pair_kernel<Pairs, Law, PairTraits<W, rolling, false, Dashpot, Advance>>();
}

template <class Pairs, int W, bool Advance, class Law>
PairKernel by_features(const KernelConfiguration& key) {
  if constexpr (fewer_kernels) {
    if (key.dashpot) return nullptr;
    return key.rolling ? by_slip<Pairs, W, Advance, Law, true, false>(key)
                       : by_slip<Pairs, W, Advance, Law, false, false>(key);
  } else {
    if (key.rolling)
      return key.dashpot ? by_slip<Pairs, W, Advance, Law, true, true>(key)
                         : by_slip<Pairs, W, Advance, Law, true, false>(key);
    return key.dashpot ? by_slip<Pairs, W, Advance, Law, false, true>(key)
                       : by_slip<Pairs, W, Advance, Law, false, false>(key);
  }
}

/// Null where there is none.
template <class Pairs, int W, bool Advance>
PairKernel pair_kernel_for(const KernelConfiguration& key) {
  return with_law(key.law, [&](auto law) -> PairKernel {
    using Force = typename decltype(law)::Force;
    if constexpr (has_kernels<decltype(law)> && (W == 1 || has_lanes<Pairs, Force>))
      return by_features<Pairs, W, Advance, Force>(key);
    return nullptr;
  });
}

template <class Pairs, int W>
void set_grain_kernels(Kernels& kernels) {
  constexpr auto none = KernelDamping::none, vector = KernelDamping::vector, component = KernelDamping::component;
  kernels.quasi_static[0] = grain_kernel<Pairs, GrainTraits<W, false, none>>();
  kernels.quasi_static[1] = grain_kernel<Pairs, GrainTraits<W, false, vector>>();
  kernels.quasi_static[2] = grain_kernel<Pairs, GrainTraits<W, false, component>>();
  if constexpr (fewer_kernels) return;
  kernels.at_rate[0] = grain_kernel<Pairs, GrainTraits<W, true, none>>();
  kernels.at_rate[1] = grain_kernel<Pairs, GrainTraits<W, true, vector>>();
  kernels.at_rate[2] = grain_kernel<Pairs, GrainTraits<W, true, component>>();
}

template <int dimension, class Law, int W, bool Advance>
constexpr InteractionKernel interaction_kernel() {
  if constexpr (dimension == 2)
    return &plane_interactions<Law, W, Advance>;
  else
    return &space_interactions<Law, W, Advance>;
}

template <int dimension, int W, class... Each>
void set_interaction_kernels(Kernels& kernels, TypeList<Each...>) {
  const InteractionKernel advancing[] = {interaction_kernel<dimension, Each, W, true>()...};
  for (int kind = 0; kind < interaction_kinds; ++kind) kernels.interactions[kind] = advancing[kind];
  if constexpr (W == 1) {
    const InteractionKernel standing[] = {interaction_kernel<dimension, Each, W, false>()...};
    for (int kind = 0; kind < interaction_kinds; ++kind) kernels.evaluate_interactions[kind] = standing[kind];
  }
}

/// The advancing kernels of one shape at W lanes; of the scalar reference those that do not advance too. Where there is
/// no pair kernel in lanes, that of the scalar reference, which is set first, stays.
template <class Pairs, int W>
void set_kernels(const KernelConfiguration& key, Kernels& kernels) {
  if (const PairKernel pairs = pair_kernel_for<Pairs, W, true>(key)) kernels.pairs = pairs;
  if constexpr (W == 1) {
    kernels.pairs_with_losses = kernels.pairs;
    kernels.evaluate = pair_kernel_for<Pairs, W, false>(key);
    if constexpr (fewer_kernels) return;  // the other loops are those of more lanes
  }
  if constexpr (Pairs::By::round && !fewer_kernels)
    set_interaction_kernels<Pairs::By::dimension, W>(kernels, InteractionLaws{});
  if constexpr (!Pairs::By::rigid) set_grain_kernels<Pairs, W>(kernels);  // bodies: step_bodies.cpp
  kernels.lanes = W;
}

}  // namespace
}  // namespace rvelab
