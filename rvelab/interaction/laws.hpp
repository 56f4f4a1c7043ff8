// The laws of interactions other than contacts. A new law is a file of its own, like its neighbours, and a word here.
#pragma once

#include "rvelab/contact/laws.hpp"
#include "rvelab/interaction/bridge.hpp"
#include "rvelab/interaction/parallel_bond.hpp"

namespace rvelab {

using InteractionLaws = TypeList<ParallelBond, CapillaryBridge>;
constexpr int bonds_kind = 0, bridges_kind = 1;
constexpr int interaction_kinds = count_of(InteractionLaws{});

}  // namespace rvelab
