#include "tools/umat/refusals.hpp"

#include <Eigen/Eigenvalues>
#include <stdexcept>

namespace umat {

namespace {

/// Whether `next` begins like `refused`. Round-off is far below a thousandth of an increment.
bool same_place(const Beginning& refused, const Beginning& next) {
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

}  // namespace

void Refusals::add(const Beginning& refused) {
  const std::lock_guard lock(mutex_);
  refused_.insert_or_assign(refused.state.id, refused);
  // Each failed first increment has a separate state; the oldest of many are removed.
  constexpr std::size_t most = 1 << 20;
  const auto first_rve = refused_.lower_bound(0);
  if (refused_.size() > most && first_rve != refused_.begin()) refused_.erase(std::prev(first_rve));
}

void Refusals::expect_obeyed(const Beginning& next) {
  const std::lock_guard lock(mutex_);
  const auto found = refused_.find(next.state.id);
  if (found == refused_.end() || found->second.state.token != next.state.token || same_place(found->second, next))
    return;
  throw std::runtime_error(
      "the host has gone on without the increment that PNEWDT below 1 refused: the RVE is where that began, and this "
      "call begins elsewhere (DFGRD0, STRAN or TIME); the host must repeat a refused increment by smaller ones (MOOSE: "
      "IterationAdaptiveDT with a MaterialTimeStepPostprocessor as timestep_limiting_postprocessor, reject_large_step "
      "= true, reject_large_step_threshold = 0.999), or take smaller steps from the start");
}

void Refusals::forget_others(const State& from) {
  const std::lock_guard lock(mutex_);
  const auto found = refused_.find(from.id);
  if (found != refused_.end() && found->second.state.token != from.token) refused_.erase(found);
}

}  // namespace umat
