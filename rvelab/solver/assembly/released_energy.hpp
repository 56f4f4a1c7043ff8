// Energy that interactions other than contacts release at once in a sub-step: as bonds break, bridges form and rupture,
// adhesive grains meet and part (solver/README.md, Energy balance). Scenes without the balance or without interactions
// do not come here.
#pragma once

#include <vector>

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

class ReleasedEnergy {
 public:
  /// What the columns say of energy, before a sub-step advances them.
  void keep(const Assembly& assembly);
  /// Books what was released since: what bonds note as they break or soften; of laws with an energy of their own, what
  /// those give up that began or ceased to act, at the gap they have now.
  void book(const Model& model, Assembly& assembly) const;

 private:
  std::vector<std::vector<Buffer>> before_;  ///< by table and column
};

}  // namespace rvelab
