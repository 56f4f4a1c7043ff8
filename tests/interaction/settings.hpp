// What interactions form from, given to an RVE.
#pragma once

#include "rvelab/solver/rve.hpp"

namespace rvelab::test {

/// Gives the specimen what interactions of a law form from; nothing: takes it away, with them.
template <class Law>
void set_settings(Rve& rve, const std::vector<typename Law::Settings>& settings) {
  Interactions all = rve.interactions();
  auto& list = static_cast<ListOf<Law>&>(all);
  list.settings = settings;
  if (settings.empty()) list.items.clear();
  rve.set_interactions(all);
}

}  // namespace rvelab::test
