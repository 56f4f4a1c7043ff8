// What a snapshot and a pool file keep of one RVE: its committed state, its tokens, and what its measures refer to.
//
// Tokens: the committed state and the last trials from it, by number. A host without a commit hook names with a token
// the state that its step begins in.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::pool {

/// What a trial was made with: enough to make it again, bit for bit.
struct TrialRecord {
  std::int64_t token = 0;
  Matrix3 displacement_gradient = Matrix3::Zero();  ///< laboratory frame
  double dt = 0;                                    ///< s
};

/// Of one RVE. Tokens count up from a first one, drawn at random below 2^52 for each pool, so that those of another
/// pool or process are seen to be foreign; a double holds more of them than there is time for.
class Tokens {
 public:
  static constexpr int kept = 16;

  Tokens() : Tokens(1) {}
  explicit Tokens(std::int64_t first) : committed_(first), next_(first + 1) {}
  std::int64_t committed() const { return committed_; }
  std::int64_t next() const { return next_; }
  int trials() const { return trials_; }
  /// The k-th kept trial, the oldest first.
  const TrialRecord& trial(int k) const { return last_[std::size_t(k)]; }
  /// The trial that a token names; nullptr: none.
  const TrialRecord* find(std::int64_t token) const {
    for (int k = trials_ - 1; k >= 0; --k)
      if (trial(k).token == token) return &trial(k);
    return nullptr;
  }

  /// A trial was made. Returns its token.
  std::int64_t add(const Matrix3& displacement_gradient, double dt) {
    if (trials_ == kept) std::move(last_.begin() + 1, last_.begin() + trials_--, last_.begin());
    add_again({next_, displacement_gradient, dt});
    return next_++;
  }
  /// The trial of that token became the state: those from the old one are over.
  void commit(std::int64_t token) {
    committed_ = token;
    trials_ = 0;
  }
  /// An increment that no trial was made of became the state. Returns its token.
  std::int64_t go_on() {
    commit(next_);
    return next_++;
  }
  /// As they were written down: the committed token, the next one, then add_again for each trial.
  void restore(std::int64_t committed, std::int64_t next) {
    commit(committed);
    next_ = next;
  }
  void add_again(const TrialRecord& trial) { last_[std::size_t(trials_++)] = trial; }

  /// "7 (committed), 9, 10", for messages.
  std::string in_words() const {
    std::string words = std::to_string(committed_) + " (committed)";
    for (int k = 0; k < trials_; ++k) words += ", " + std::to_string(trial(k).token);
    return words;
  }

 private:
  std::int64_t committed_, next_;
  std::array<TrialRecord, kept> last_;
  int trials_ = 0;
};

/// What is reported of a committed step, or of a trial (Report).
struct StepFigures {
  double inertial_number = 0;
  double error_estimate = 0;  ///< Pa, of the stress after it
};

struct RveState {
  Specimen specimen;
  Tokens tokens;
  double initial_void_ratio = 0;  ///< when the RVE was spawned
  StepFigures last{};
};

/// Bitwise, for builds with the same fields: a head with magic, length and checksum, tokens, the bytes of Rve::save().
/// `specimen`: these bytes; state.specimen is not read.
std::vector<std::byte> to_bytes(const RveState& state, std::span<const std::byte> specimen);

/// Throws Refused (bad_snapshot) if the bytes are not such, were cut or changed, or are of another build.
RveState rve_state_of(std::span<const std::byte> bytes);

}  // namespace rvelab::pool
