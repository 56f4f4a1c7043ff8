// The laws of interactions other than contacts. A new law is a file of its own, like its neighbours, and a word here.
#pragma once

#include "rvelab/contact/laws.hpp"
#include "rvelab/interaction/bridge.hpp"
#include "rvelab/interaction/contact_bond.hpp"
#include "rvelab/interaction/dmt.hpp"
#include "rvelab/interaction/jkr.hpp"
#include "rvelab/interaction/parallel_bond.hpp"
#include "rvelab/interaction/softening_bond.hpp"
#include "rvelab/interaction/surface_bond.hpp"

namespace rvelab {

using InteractionLaws =
    TypeList<ParallelBond, CapillaryBridge, SurfaceBond, ContactBond, JkrAdhesion, DmtAdhesion, SofteningBond>;
constexpr int interaction_kinds = count_of(InteractionLaws{});
template <class... Laws>
constexpr int forming_laws(TypeList<Laws...>) {
  return (0 + ... + int(FormsByItself<Laws>));
}

}  // namespace rvelab
