// Snapshots of one pool beside those of another: all but their tokens, whose first one each pool draws at random.
#pragma once

#include <span>
#include <vector>

#include "rvelab/pool/rve_state.hpp"
#include "rvelab/solver/snapshot.hpp"

namespace rvelab::test {

/// The same state with tokens that count from 1, the committed one.
inline std::vector<std::byte> with_tokens_from_one(std::span<const std::byte> snapshot) {
  pool::RveState state = pool::rve_state_of(snapshot);
  const pool::Tokens given = state.tokens;
  const std::int64_t before = given.committed() - 1;
  state.tokens.restore(1, given.next() - before);
  for (int k = 0; k < given.trials(); ++k) {
    pool::TrialRecord trial = given.trial(k);
    trial.token -= before;
    state.tokens.add_again(trial);
  }
  return pool::to_bytes(state, to_bytes(state.specimen));
}

}  // namespace rvelab::test
