// What the springs of contacts lose in a sub-step, for the kernels that keep the energy balance (scalar).
#pragma once

#include "rvelab/lanes/vectors.hpp"
#include "rvelab/solver/kernels/configuration.hpp"

namespace rvelab {
namespace {

inline double dot(double a, double b) { return a * b; }
inline double plus(double a, double factor, double b) { return a + factor * b; }

/// A tangential or rolling spring over one sub-step. X: its force along the tangent or moment about z in the plane,
/// vectors in space.
template <class X>
struct SpringStep {
  X before, carried, trial, after;   ///< N: stored; after the law's factor; with the increment; within its cap
  X increment;                       ///< N, what the motion takes off
  double stiffness, last_stiffness;  ///< N/m now and when `before` was stored; 0 for none
};

/// Adds to `slip` the work against the cap, J: that of the mean of old and new force. With the new one alone, what a
/// cap that falls takes out of a soft spring is missing (kt/kn = 1e-3: 15 % of the energy). What a spring holds when
/// its contact opens is lost as slip too. `law_loss`: what a law takes by its factor on the stored force.
template <bool factor, class X>
inline void book_spring(const SpringStep<X>& s, bool touching, double& slip, double& law_loss) {
  if (!touching) {
    if (s.last_stiffness > 0) slip += 0.5 * dot(s.before, s.before) / s.last_stiffness;
  } else if (s.stiffness > 0) {
    slip += 0.5 * dot(plus(s.trial, -1.0, s.after), plus(plus(s.after, 1.0, s.trial), 1.0, s.increment)) / s.stiffness;
    if (factor && s.last_stiffness > 0)
      law_loss += 0.5 * (dot(s.before, s.before) / s.last_stiffness - dot(s.carried, s.carried) / s.stiffness);
  }
}

}  // namespace
}  // namespace rvelab
