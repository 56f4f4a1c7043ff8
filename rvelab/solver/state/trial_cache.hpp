// What trials of one committed state begin with, where that takes work: masses that are scaled, a stress that has
// settled. The trial that did the work leaves a copy, and those that follow begin with it, to the same bits: an
// implicit host, or one that takes a tangent by differences, makes many trials of each state.
#pragma once

#include <vector>

#include "rvelab/solver/assembly/assembly.hpp"

namespace rvelab {

/// What an increment's relaxation depends on and was, by which another increment knows whether it would make the same
/// (quasi_static/relaxation.hpp).
struct CachedRelaxation {
  // Of the state before its first sub-step.
  Matrix3 rate = Matrix3::Zero();  ///< of the last sub-step, 1/step
  double strain_since_reversal = 0, network_stiffness = 0, stiffness_ratio = 1;
  double target_unbalanced_ratio = 0;
  double pressure = 0, pressure_scale = 0;  ///< Pa
  double error_per_ratio = 0;               ///< K p, Pa
  bool not_yet_checked = false;             ///< its end wants a check (quasi_static/check.hpp)

  std::vector<double> error;     ///< K p u before the first part and after each, Pa
  std::vector<Matrix3> stress;   ///< before each part, cell frame, Pa
  double creep_of_rolling = -1;  ///< Pa, where grains roll; below zero: not measured

  std::size_t parts() const { return stress.size(); }
};

class TrialCache {
 public:
  TrialCache() = default;
  /// A copied RVE has none, and keeps one of its own.
  TrialCache(const TrialCache&) noexcept {}
  TrialCache& operator=(const TrialCache&) = delete;
  TrialCache(TrialCache&&) = default;
  TrialCache& operator=(TrialCache&&) = default;

  bool kept() const { return kept_; }
  CachedRelaxation& cached_relaxation() { return relaxation_; }
  /// Copies what a trial has made of the committed state so far. Not if memory is short, nor where the lattice was
  /// reduced meanwhile: an increment was split in the frame before.
  void keep(const Assembly& assembly, const Matrix3& committed_lattice, CachedRelaxation relaxation) noexcept;
  /// Into a trial of the same committed state that has just begun: what keep() found, forces too.
  void take_over(Assembly& assembly) const;
  void drop() noexcept { kept_ = false; }
  std::size_t bytes() const;

 private:
  bool kept_ = false, own_list_ = false, own_masses_ = false;
  CachedRelaxation relaxation_;
  Cell cell_;
  Buffer rows_, mass_, inverse_mass_, inverse_inertia_;
  BodyMotions bodies_;
  PairTable list_;               ///< where it was made again, else empty
  std::vector<Buffer> changed_;  ///< of the committed list: what sub-steps change
  std::vector<std::uint8_t> touched_;
  SolverState state_;
};

}  // namespace rvelab
