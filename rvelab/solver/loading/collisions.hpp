// What the collisions under way and those that are coming ask of the time step at a rate.
//
// The critical step is a limit of stability. A collision that it takes in two or three sub-steps ends with anything
// from 0.7 to 1.3 of its energy: with leapfrog and a spring, energy after over energy before is
// (1 - a f (1 - f)) / (1 - a f' (1 - f')), a = (omega dt)^2, f and f' the parts of a sub-step at which contact begins
// and ends. So where collisions carry the energy, omega dt = pi / collision_steps, with omega^2 = kn / m* of a pair
// (linear) or 3/2 k sqrt(delta) / m* at the overlap delta that the approach will reach,
// delta^2.5 = 5/4 m* v^2 / k (Hertz: Landau and Lifshitz, Theory of Elasticity, section 9).
//
// Grains in flight must not reach each other's surface in a step that does not know of them: a sub-step crosses at most
// a twentieth of the skin. And where the cell itself closes the gaps (a shock), it does so in `increment_steps` parts
// of the overlap that comes of it at least, whatever the time scale of the grains.
//
// Where the energy is in contacts at rest, a collision may be cruder: the error of the whole is its error times the
// dynamic share s^2 = (energy of approach + resultants' energy R^2 / 2k) / elastic energy, so that omega dt may be
// pi / collision_steps / s. A dense flow at small inertial number keeps the critical step.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/loading/inertia.hpp"

namespace rvelab {

struct Collisions {
  double step = 0;      ///< s, longest sub-step that follows them; infinite where nothing asks for one
  double look = 0;      ///< s, after which pairs that are not listed now may be about to collide; infinite likewise
  bool deep = false;    ///< within the horizon an overlap may come near the limit: it is checked every few steps
  bool beyond = false;  ///< an overlap is beyond the limit now, or energies of the pairs and grains are not finite
};

/// How far ahead collisions are sought.
struct Outlook {
  Matrix3 rate = Matrix3::Zero();  ///< velocity gradient of the cell, cell frame, 1/s
  double horizon = 0;              ///< s, until the next check
  double increment = 0;            ///< s, of the whole increment: what the rate makes of the overlaps in it
  double step = 0;                 ///< s, the sub-step in use: only shorter ones matter; 0: all do
};

/// Goes through all listed pairs that touch, or that meet within the horizon at their present velocities. The
/// velocities must be physical (at a rate). Row sums are made where they are not at hand (null) and could matter: a
/// step that is not shorter than the one in use is then a lower bound. With `find_step` false only `deep` is found.
Collisions collisions_ahead(const Model& model, const Assembly& assembly, const RowSums* sums, bool find_step,
                            const Outlook& outlook);

}  // namespace rvelab
