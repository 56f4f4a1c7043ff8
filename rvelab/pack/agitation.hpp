// Grains that are agitated without lasting contacts, as in a sand that is shaken, tapped or rained: the cell expands
// until no grain touches another, the grains collide elastically and without friction, and stand still again.
// Compressed with its own friction, such an assembly has about the density of before and far fewer contacts. Density
// and number of contacts are independent of each other (Agnolin and Roux 2007, Phys. Rev. E 76, 061302, state C).
#pragma once

#include "rvelab/grains/uniform.hpp"
#include "rvelab/pack/draw_watch.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::pack {

/// An assembly that carries a stress, its cell expanded by the strain `expansion` along each axis; its grains are where
/// the collisions brought them, without velocities, histories of contacts, or friction. Not at rest. IncrementFailed;
/// Interrupted.
Rve agitated(const Rve& rve, double expansion, Uniform& uniform, const DrawWatch& watch);

}  // namespace rvelab::pack
