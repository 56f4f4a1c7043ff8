// The functions that fill in the kernels of a configuration, one for each shape and instruction set: SHAPE's are in
// step_SHAPE.cpp, those of bodies of all shapes in step_bodies.cpp. A build defines those that its compiler can make.
#pragma once

#include "rvelab/solver/kernels/configuration.hpp"

namespace rvelab {

template <Shape shape>
struct StepKernels {
  /// All of them, those with losses and the evaluation of stored histories too, which are scalar on every machine.
  static void scalar(const KernelConfiguration&, Kernels&);
  /// Pair and grain loops.
  static void baseline(const KernelConfiguration&, Kernels&);
  static void v3(const KernelConfiguration&, Kernels&);
  static void v4(const KernelConfiguration&, Kernels&);
};

#define RVELAB_DECLARE(shape, description)                                        \
  template <>                                                                     \
  void StepKernels<Shape::shape>::scalar(const KernelConfiguration&, Kernels&);   \
  template <>                                                                     \
  void StepKernels<Shape::shape>::baseline(const KernelConfiguration&, Kernels&); \
  template <>                                                                     \
  void StepKernels<Shape::shape>::v3(const KernelConfiguration&, Kernels&);       \
  template <>                                                                     \
  void StepKernels<Shape::shape>::v4(const KernelConfiguration&, Kernels&);
RVELAB_SHAPES(RVELAB_DECLARE)
#undef RVELAB_DECLARE

/// The loops over bodies and members, of shapes that have bodies.
struct BodyKernels {
  static void scalar(const KernelConfiguration&, Kernels&);
  static void baseline(const KernelConfiguration&, Kernels&);
  static void v3(const KernelConfiguration&, Kernels&);
  static void v4(const KernelConfiguration&, Kernels&);
};

}  // namespace rvelab
