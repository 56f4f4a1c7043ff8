// Interactions other than contacts (rvelab/interaction) in an assembly: taken from a specimen and given back, listed
// with the pairs, updated in each sub-step. An assembly without any pays for none of it.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

/// Puts them into the table, in order; their derived arrays are made with those of the pairs.
void set_interactions(const Model& model, const Interactions& from, PairTable& pairs);
/// `all`: also what stands for pairs that are only near, of laws whose interactions form by themselves.
Interactions interactions_of(const PairTable& pairs, bool all = false);
/// Interactions that may form: of each law whose settings the specimen has, each pair that is listed (or nearer than
/// `skin` beyond the law's reach), in order, has one; those that are not kept and not listed go. Returns the energy (J)
/// that new ones release which act at once, their grains having met since the last list; 0 without the energy balance.
double prepare_interactions(const Model& model, const Assembly& assembly, const std::vector<ListedPair>& listed,
                            double skin, Interactions& interactions);
/// Those that a specimen has become what its settings make of them.
void prepare_interactions(Specimen& specimen);
/// After the basis of the lattice changed, the frame turned by `turn`, grains g moved by moved[g] lattice vectors.
void follow_reduction(const Reduction& reduction, int dimension, Interactions& interactions);
void follow_wrapping(const std::vector<Image>& moved, int dimension, Interactions& interactions);

/// Derived arrays, with the force rows of pairs and interactions (zero).
void derive_interactions(const Model& model, PairTable& pairs);

/// Advances them by a sub-step.
void update_interactions(const Model& model, const Kernels& kernels, const StepConstants& constants,
                         Assembly& assembly);
/// Force rows from what they keep; nothing advances.
void evaluate_interactions(const Model& model, const StepConstants& constants, Assembly& assembly);

/// One that acts, as it lies now. Cell frame; forces and moments are those on grain j.
struct ActingInteraction {
  int kind = 0;
  std::size_t i, j, row;  ///< grains; where it stands in its table
  Vector3 branch, normal;
  double length, arm_i, arm_j;  ///< m
  Vector3 force;                ///< N
  Vector3 moment_i, moment_j;   ///< N m, on either grain about its centre
  InteractionStiffness stiffness;
  double normal_force;  ///< N, positive in compression
  bool has_energy = false;
  double energy = 0;  ///< J, where the law has one by itself: else that of linear springs
};
/// In order, kind by kind, from the force rows as they stand. `energies`: those of laws that have one by themselves are
/// wanted; a bridge's is an integral, which stress control did not ask for (200 moist spheres: 50 times the time).
std::vector<ActingInteraction> acting_interactions(const Model& model, const Assembly& assembly, bool energies = false);

/// What control asks of them. `acting` changes whenever one begins or ceases to act; it hangs on the ids of their
/// grains alone.
struct InteractionSums {
  double push = 0, pull = 0;  ///< of |f_n| l where they push and where they pull, N m
  double stiffness = 0;       ///< of k_n l^2 where k_n > 0, N m
  std::uint64_t acting = 0;
  double broken =
      0;  ///< of the squares of f l of those that have broken, N^2 m^2; f^2 = 2 k_n times what they released
};
InteractionSums interaction_sums(const Model& model, const Assembly& assembly);

/// Their part of contact_virial, N m.
Matrix3 interaction_virial(const Model& model, const Assembly& assembly);
inline bool has_interactions(const Assembly& assembly) { return !assembly.pairs.interactions.empty(); }

}  // namespace rvelab
