// Bonds that break, bridges that rupture or form within an increment of quasi-static loading.
#pragma once

#include <algorithm>
#include <cmath>

#include "rvelab/solver/state/state.hpp"

namespace rvelab {

class InteractionEvents {
 public:
  /// Notes what acts as the increment begins. Without interactions nothing is asked, here and below.
  explicit InteractionEvents(State& state) {
    if (has_interactions(state.assembly())) before_ = state.interaction_sums();
  }
  /// Whether another set of them acts now.
  bool happened(State& state) const {
    return has_interactions(state.assembly()) && state.interaction_sums().acting != before_.acting;
  }
  /// Root of the sum of squares of what the bonds that broke bore of the stress, Pa.
  double broken_stress(State& state) const {
    if (!has_interactions(state.assembly())) return 0;
    return std::sqrt(std::max(0.0, state.interaction_sums().broken - before_.broken)) / state.cell().volume();
  }

 private:
  InteractionSums before_;
};

}  // namespace rvelab
