// Turns a configuration into compiled kernels: one switch per flag, each ending in a template argument.
#pragma once

#include "rvelab/solver/kernels/discs.hpp"
#include "rvelab/solver/kernels/ellipses.hpp"
#include "rvelab/solver/kernels/integrate_discs.hpp"
#include "rvelab/solver/kernels/integrate_ellipses.hpp"
#include "rvelab/solver/kernels/integrate_spheres.hpp"
#include "rvelab/solver/kernels/spheres.hpp"

namespace rvelab {
namespace {

template <Shape shape, class Law, class T>
constexpr PairKernel pair_kernel() {
  if constexpr (shape == Shape::disc)
    return &plane_pairs<Discs, Law, T>;
  else if constexpr (shape == Shape::ellipse)
    return &plane_pairs<Ellipses, Law, T>;
  else
    return &space_pairs<Spheres, Law, T>;
}

template <Shape shape, class T>
constexpr GrainKernel grain_kernel() {
  if constexpr (shape == Shape::disc)
    return &plane_grains<DiscRows, T>;
  else if constexpr (shape == Shape::ellipse)
    return &plane_grains<EllipseRows, T>;
  else
    return &sphere_grains<T>;
}

template <Shape shape, int W, bool Advance, class Law, bool Rolling, bool Dashpot>
PairKernel by_slip(const KernelConfiguration& key) {
  // The conventions of other codes are those of round grains: a specimen of ellipses has no other.
  if constexpr (shape == Shape::ellipse) {
    if constexpr (Law::has_hertz_radius) {
      constexpr auto curvature = HertzRadius::curvature;
      if (key.hertz_radius == curvature)
        return pair_kernel<shape, Law, PairTraits<W, Rolling, Slip::consistent, Dashpot, Advance, curvature>>();
    }
    return pair_kernel<shape, Law, PairTraits<W, Rolling, Slip::consistent, Dashpot, Advance>>();
  }
  // Without motion there is no slip. The conventions of other codes serve comparison with these and are compiled for
  // narrow lanes alone (choice.cpp).
  if constexpr (W <= 2 && (Advance || Dashpot)) {
    if (key.slip == Slip::full_radius)
      return pair_kernel<shape, Law, PairTraits<W, Rolling, Slip::full_radius, Dashpot, Advance>>();
    if (key.slip == Slip::full_radius_ratcheting)
      return pair_kernel<shape, Law, PairTraits<W, Rolling, Slip::full_radius_ratcheting, Dashpot, Advance>>();
  }
  return pair_kernel<shape, Law, PairTraits<W, Rolling, Slip::consistent, Dashpot, Advance>>();
}

template <Shape shape, int W, bool Advance, class Law>
PairKernel by_features(const KernelConfiguration& key) {
  if (key.rolling)
    return key.dashpot ? by_slip<shape, W, Advance, Law, true, true>(key)
                       : by_slip<shape, W, Advance, Law, true, false>(key);
  return key.dashpot ? by_slip<shape, W, Advance, Law, false, true>(key)
                     : by_slip<shape, W, Advance, Law, false, false>(key);
}

template <Shape shape, int W, bool Advance>
PairKernel pair_kernel_for(const KernelConfiguration& key) {
  return with_law(key.law,
                  [&](auto law) { return by_features<shape, W, Advance, typename decltype(law)::Force>(key); });
}

template <Shape shape, int W, bool Rolling>
void set_grain_kernels(Kernels& kernels) {
  constexpr auto none = KernelDamping::none, vector = KernelDamping::vector, component = KernelDamping::component;
  kernels.quasi_static[0] = grain_kernel<shape, GrainTraits<W, Rolling, false, none>>();
  kernels.quasi_static[1] = grain_kernel<shape, GrainTraits<W, Rolling, false, vector>>();
  kernels.quasi_static[2] = grain_kernel<shape, GrainTraits<W, Rolling, false, component>>();
  kernels.dynamic[0] = grain_kernel<shape, GrainTraits<W, Rolling, true, none>>();
  kernels.dynamic[1] = grain_kernel<shape, GrainTraits<W, Rolling, true, vector>>();
  kernels.dynamic[2] = grain_kernel<shape, GrainTraits<W, Rolling, true, component>>();
}

/// The advancing kernels of one shape at W lanes.
template <Shape shape, int W>
void set_kernels(const KernelConfiguration& key, const char* instruction_set, Kernels& kernels) {
  kernels.pairs = pair_kernel_for<shape, W, true>(key);
  if (key.rolling)
    set_grain_kernels<shape, W, true>(kernels);
  else
    set_grain_kernels<shape, W, false>(kernels);
  kernels.lanes = W;
  kernels.instruction_set = instruction_set;
}

}  // namespace
}  // namespace rvelab
