// Failed increments (PNEWDT below 1). A host that ignores PNEWDT continues from the end of the failed increment, while
// the RVE is still at its start; the next call of the host reveals this.
#pragma once

#include <Eigen/Eigenvalues>
#include <map>
#include <mutex>
#include <stdexcept>

#include "tools/umat/points.hpp"

namespace umat {

/// The start of a call, from the arguments of the host.
struct Beginning {
  State state;
  Matrix3 F0 = Matrix3::Identity(), F1 = Matrix3::Identity();  ///< unit matrices if the host gives none
  Matrix3 strain = Matrix3::Zero(), strain_increment = Matrix3::Zero();
  double time = 0, dt = 0;  ///< s
};

class Refusals {
 public:
  /// The increment from this start has failed.
  void add(const Beginning& refused) {
    const std::lock_guard lock(mutex_);
    refused_.insert_or_assign(refused.state.id, refused);
    // Each failed first increment has a separate state; the oldest of many are removed.
    constexpr std::size_t most = 1 << 20;
    const auto first_rve = refused_.lower_bound(0);
    if (refused_.size() > most && first_rve != refused_.begin()) refused_.erase(std::prev(first_rve));
  }

  /// Throws if an increment from the state of `next` has failed and `next` has another start: another DFGRD0; if that
  /// is the unit matrix, other principal values of STRAN; or a later time.
  void expect_obeyed(const Beginning& next) {
    const std::lock_guard lock(mutex_);
    const auto found = refused_.find(next.state.id);
    if (found == refused_.end() || found->second.state.token != next.state.token || same_place(found->second, next))
      return;
    throw std::runtime_error(
        "the host has gone on without the increment that PNEWDT below 1 refused: the RVE is where that began, and this "
        "call begins elsewhere (DFGRD0, STRAN or TIME); the host must repeat a refused increment by smaller ones "
        "(MOOSE: IterationAdaptiveDT with a MaterialTimeStepPostprocessor as timestep_limiting_postprocessor, "
        "reject_large_step = true, reject_large_step_threshold = 0.999), or take smaller steps from the start");
  }

  /// A step was made from this state: failures from another state of its RVE are removed.
  void forget_others(const State& from) {
    const std::lock_guard lock(mutex_);
    const auto found = refused_.find(from.id);
    if (found != refused_.end() && found->second.state.token != from.token) refused_.erase(found);
  }

 private:
  /// Whether `next` begins like `refused`. Round-off is far below a thousandth of an increment.
  static bool same_place(const Beginning& refused, const Beginning& next) {
    constexpr double tolerance = 1e-3;
    if (next.time - refused.time > tolerance * refused.dt && refused.dt > 0) return false;
    if (refused.F0 != Matrix3::Identity() || next.F0 != Matrix3::Identity())
      return (next.F0 - refused.F0).norm() <= tolerance * (refused.F1 - refused.F0).norm();
    // Hosts may have rotated the strain by the coming increment.
    const auto principal = [](const Matrix3& strain) {
      return Eigen::SelfAdjointEigenSolver<Matrix3>(strain, Eigen::EigenvaluesOnly).eigenvalues();
    };
    return (principal(next.strain) - principal(refused.strain)).norm() <= tolerance * refused.strain_increment.norm();
  }

  std::mutex mutex_;
  std::map<std::int64_t, Beginning> refused_;  ///< the last one of each RVE
};

}  // namespace umat
