// Tokens: the committed state and the last trials from it, by number. A host without a commit hook names with a token
// the state that its step begins in.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "rvelab/cell/cell.hpp"

namespace rvelab::pool {

/// What a trial was made with: enough to make it again, bit for bit.
struct TrialRecord {
  std::int64_t token = 0;
  Matrix3 displacement_gradient = Matrix3::Zero();  ///< laboratory frame
  double dt = 0;                                    ///< s
};

/// Of one RVE. Tokens count up from 1; a double holds more of them than there is time for.
class Tokens {
 public:
  static constexpr int kept = 16;

  std::int64_t committed() const { return committed_; }
  std::int64_t next() const { return next_; }
  int trials() const { return trials_; }
  /// The k-th kept trial, the oldest first.
  const TrialRecord& trial(int k) const { return ring_[std::size_t((first_ + k) % kept)]; }
  /// The trial that a token names; nullptr: none.
  const TrialRecord* find(std::int64_t token) const {
    for (int k = trials_ - 1; k >= 0; --k)
      if (trial(k).token == token) return &trial(k);
    return nullptr;
  }

  /// A trial was made. Returns its token.
  std::int64_t add(const Matrix3& displacement_gradient, double dt) {
    if (trials_ == kept) {
      first_ = (first_ + 1) % kept;
      --trials_;
    }
    ring_[std::size_t((first_ + trials_++) % kept)] = {next_, displacement_gradient, dt};
    return next_++;
  }
  /// The trial of that token became the state: those from the old one are over.
  void commit(std::int64_t token) {
    committed_ = token;
    first_ = trials_ = 0;
  }
  /// As they were written down: the committed token, the next one, then add_again for each trial.
  void restore(std::int64_t committed, std::int64_t next) {
    committed_ = committed;
    next_ = next;
    first_ = trials_ = 0;
  }
  void add_again(const TrialRecord& trial) { ring_[std::size_t(trials_++)] = trial; }

  /// "7 (committed), 9, 10", for messages.
  std::string in_words() const {
    std::string words = std::to_string(committed_) + " (committed)";
    for (int k = 0; k < trials_; ++k) words += ", " + std::to_string(trial(k).token);
    return words;
  }

 private:
  std::int64_t committed_ = 1, next_ = 2;
  std::array<TrialRecord, kept> ring_;
  int first_ = 0, trials_ = 0;
};

}  // namespace rvelab::pool
