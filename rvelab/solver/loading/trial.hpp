// A trial increment and what it started from: committed or reverted, the one way in which a failure is undone.
//
// What steps change is copied when a trial begins: cell, grain rows, masses, histories and force rows, the state of the
// solver. Lists and what follows from them are not: the first that a trial replaces is kept as it is, and put back. Of
// 400 discs that is 100 kB a call instead of 230.
#pragma once

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

class Trial {
 public:
  Trial() = default;
  /// A copied RVE has no trial pending, and makes buffers of its own when it needs them.
  Trial(const Trial&) noexcept {}
  Trial& operator=(const Trial&) = delete;
  Trial(Trial&&) = default;
  Trial& operator=(Trial&&) = default;

  /// Notes what `assembly` is: its committed state.
  void begin(Assembly& assembly);
  /// The committed state and that of the trial change places, bit for bit; once more, and they are where they were.
  /// Allocates nothing.
  void exchange(Assembly& assembly) noexcept;
  /// No trial is pending. What `assembly` is now is its state: the committed one after an exchange.
  void end(Assembly& assembly) noexcept;
  bool pending() const { return pending_; }
  /// Lets go of the buffers that the next trial would use. Nothing may be pending.
  void release() { *this = Trial(); }
  std::size_t bytes() const;

 private:
  Cell cell_;
  Buffer rows_, mass_, inverse_mass_, inverse_inertia_;
  Buffer tangential_[3], moment_[3], root_overlap_, force_;
  std::vector<std::uint8_t> touched_;
  SolverState state_;
  ReplacedList replaced_;
  bool pending_ = false;
  bool list_is_whole_ = false;  ///< the replaced list holds the committed histories, not those when it was replaced
};

}  // namespace rvelab
