// One pass of a kernel over all pairs or all grains of an assembly: piece by piece, the pieces of a large one shared
// among a team of threads. Pieces depend on nothing but their number, and their sums are added in order, so that the
// result has the same bits on any team and on none.
//
// Both loops in one, where the caches do not hold the cell: a grain may move on once the pairs in which it lies are
// updated, and these are (i, j) with i no larger than its number. So the pairs of a sub-step wait for the grain loop of
// the next one, which asks for those of the grains up to each chunk before it gathers; what they wrote is in the cache
// then.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/kernels/configuration.hpp"
#include "rvelab/threads/workers.hpp"

namespace rvelab {

/// `team` may be null.
void sweep_pairs(PairKernel kernel, const StepConstants& constants, const PairArrays& pairs, const double* grain_rows,
                 long padded_pairs, Workers* team);
void sweep_grains(GrainKernel kernel, const StepConstants& constants, const GrainArrays& grains,
                  const PairArrays& pairs, long padded_grains, Workers* team, StepSums& sums);

/// Forces to the members of bodies, bodies, members: three passes, between which a team waits for its last thread.
void sweep_bodies(const Kernels& kernels, bool at_rate, const StepConstants& constants, const BodyConstants& of_bodies,
                  const GrainArrays& grains, const PairArrays& pairs, const BodyArrays& bodies, long padded_bodies,
                  long padded_members, Workers* team, StepSums& sums);

/// Grains from which pairs wait, on one thread (Zen 4, 32 MB of cache: 256,000 spheres take 0.71 of the time, 32,000
/// spheres and 10,000 discs as long as in two loops). A team holds more in its caches, and its pieces go apart.
constexpr std::size_t least_grains_in_one_sweep = 30'000;

/// The pairs of a sub-step that wait for the grains of the next one.
class WaitingPairs {
 public:
  /// What stands in a new list; `pairs` must stay where it is.
  void arrange(PairKernel kernel, PairTable& pairs);
  /// From here on pairs wait, to be updated with these constants.
  void wait(const StepConstants& constants);
  bool any() const { return waiting_; }
  /// As sweep_grains on one thread, with the pairs that wait.
  void sweep_with_grains(GrainKernel kernel, const StepConstants& constants, GrainArrays grains,
                         const PairArrays& pairs, long padded_grains, StepSums& sums);

 private:
  /// Places of pairs, multiples of eight: those from `next` to `ascending_end` are sorted by i.
  struct Places {
    long begin = 0, ascending_end = 0, end = 0, next = 0;
  };
  void update(long begin, long end);
  void update_up_to(long grain);

  PairKernel kernel_ = nullptr;
  PairTable* table_ = nullptr;
  StepConstants constants_;
  PairArrays pairs_;
  const double* rows_ = nullptr;
  Places near_, beyond_;
  bool waiting_ = false;
};

}  // namespace rvelab
