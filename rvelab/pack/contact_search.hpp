// The search for a number of contacts and their fabric, at one density: agitated grains are compressed again and again,
// by the expansion and the difference of strains that the compressions before point at.
#pragma once

#include <vector>

#include "rvelab/pack/noisy_root.hpp"
#include "rvelab/pack/recipe.hpp"
#include "rvelab/solver/assembly/network.hpp"

namespace rvelab::pack {

/// Grains compressed after an agitation, nearly at rest with their own friction.
struct Compressed {
  Agitation by;
  double void_ratio = 0, coordination_number = 0, fabric_anisotropy = 0;
  bool meets(const ContactTarget& target) const;
  /// With the coordination number of the target instead of its own, about.
  double void_ratio_at(const ContactTarget& target) const;
};

Compressed compressed_state(const Recipe& recipe, const Agitation& by, const Network& network);

class ContactSearch {
 public:
  ContactSearch(const Recipe& recipe, const Agitation& first);
  Agitation next() const;
  void add(const Compressed& made);
  /// Whether the last one is accepted; whether no further one is worth its time.
  bool met() const;
  bool given_up() const { return in_vain() || density_is_missed(); }
  /// Whether the target is out of reach, or was not met in as many compressions as are made for one.
  bool in_vain() const;
  const std::vector<Compressed>& made() const { return made_; }

 private:
  bool density_is_missed() const;

  const Recipe& recipe_;
  NoisyRoot expansion_, difference_;  ///< in ln of the expansion
  std::vector<Compressed> made_;
};

/// "coordination numbers of 4.1 to 6.2 at void ratios of 0.52 to 0.55": what compressions reached.
std::string reached_in_words(const std::vector<Compressed>& made);
/// The same of the fabric, along an axis.
std::string fabric_in_words(const std::vector<Compressed>& made);

}  // namespace rvelab::pack
