// One draw (trial packing): grains scattered at random, brought into contact, to the stress, and to rest with their
// final friction.
#pragma once

#include "rvelab/error.hpp"
#include "rvelab/pack/contact_search.hpp"
#include "rvelab/pack/draw_watch.hpp"
#include "rvelab/pack/recipe.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::pack {

/// Grains of a draw overlap by more than the recipe's solver.max_overlap_ratio; other draws would too. The message says
/// why the grains are so soft.
struct OverlapBeyondLimit : IncrementFailed {
  using IncrementFailed::IncrementFailed;
};

struct Draw {
  double friction = 0;    ///< of the preparation
  double void_ratio = 0;  ///< with the final friction, at the stress
  bool at_rest = false;   ///< stress and balance within the recipe's tolerances; false: given up, since the void ratio
                          ///< is too far from the target
  std::string why_not;    ///< how far the grains were from rest, where they were not at rest
  Agitation next_agitation;            ///< by which the next draw at this density would begin
  bool contacts_in_vain = false;       ///< no compression had the contacts of the target
  std::vector<Compressed> compressed;  ///< of agitated grains: each trial, the last one is the specimen
  Specimen specimen;                   ///< of a draw at rest
};

/// Makes draw `number` (from 1) of a recipe with the given preparation friction; the same bits for the same four.
/// `agitation`: that which a search for the contacts begins with. IncrementFailed if the grains do not come to the
/// stress; NotAtRest; OverlapBeyondLimit; Interrupted.
Draw draw(const Recipe& recipe, long number, double friction, const DrawWatch& watch, const Agitation& agitation = {});

}  // namespace rvelab::pack
