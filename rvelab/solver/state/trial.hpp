// A trial increment and what it started from: committed or reverted, the one way in which a failure is undone.
//
// What every step changes is copied when a trial begins: cell, grain rows, histories, the state of the solver. What few
// do, lists and masses, is not: the first that a trial replaces is kept as it is, and put back. Forces follow from the
// rest and are evaluated again where a state is put back. Of 400 discs that is 35 kB a call; with forces and masses it
// was 90, with lists 230, and a thousand RVEs with one sub-step a call spent two fifths of their time on it. An
// increment whose strain is deferred moves no grain: its trial is the cell and that strain.
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

  enum class Changes {
    grains,          ///< whatever a sub-step changes
    deferred_strain  ///< the deferred stretch and the cell's rotation, no more
  };
  /// Notes what `assembly` is: its committed state.
  void begin(Assembly& assembly, Changes changes);
  Changes changes() const { return changes_; }
  /// The committed state and that of the trial change places, bit for bit; once more, and they are where they were.
  /// Allocates nothing. Forces are those of before: if grains changed they are stale until
  /// evaluate_forces_again.
  void exchange(Assembly& assembly) noexcept;
  /// That of the state which is not in the assembly.
  const Cell& other_cell() const { return cell_; }
  /// No trial is pending. What `assembly` is now is its state: the committed one after an exchange.
  void end(Assembly& assembly) noexcept;
  bool pending() const { return pending_; }
  /// Releases the buffers that the next trial would use. Nothing may be pending.
  void release() { *this = Trial(); }
  std::size_t bytes() const;

 private:
  Changes changes_ = Changes::grains;
  Cell cell_;
  Matrix3 deferred_stretch_ = Matrix3::Identity();
  Buffer rows_;
  BodyMotions bodies_;
  Buffer tangential_[3], moment_[3], root_overlap_;
  std::vector<std::vector<Buffer>> interactions_;  ///< columns, by table
  SolverState state_;  ///< without the positions of the list, while `replaced_` has not taken them
  Replaced replaced_;
  bool pending_ = false;
  bool list_is_whole_ = false;  ///< the replaced list holds the committed histories, not those when it was replaced
};

/// Forces of a state that took the place of another: no pair is passed over because it did not touch there.
void evaluate_forces_again(const Model& model, Assembly& assembly) noexcept;

}  // namespace rvelab
