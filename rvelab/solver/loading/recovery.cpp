#include "rvelab/solver/loading/recovery.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "rvelab/error.hpp"

namespace rvelab {

namespace {

/// Errors from which a target waits, over its tolerance, and at least: what the servo leaves of a turn of the loading
/// is less, and settles on the way.
constexpr double far_off = 4, least_far_off = 0.02;

/// No network is there: fewer contacts per grain than any that carries stress, and next to none of it.
constexpr double apart = 2, gone = 0.9;

/// From one look to the next, and in all: a tenth of an overlap a sub-step, at which the servo is still in time.
constexpr double growth_per_look = 1.4, most_growth = 30;

/// Shear of a wait that is flow. Cells that came apart in avalanches closed by 2e-2 at most.
constexpr double flow = 0.5;

}  // namespace

void Recovery::judge(double error) {
  if (longest_wait_ >= 0) return;
  error_ = error;
  if (error > std::max(far_off * tolerance_, least_far_off)) under_way_ = true;
  if (error > tolerance_) return;
  under_way_ = false;
  growth_ = 1;
  sheared_ = 0;
}

long Recovery::patience(long substeps) {
  if (longest_wait_ < 0) return std::numeric_limits<long>::max();
  // In stiff packings the increment itself takes thousands of sub-steps, and what it stirs up calms as slowly.
  if (substeps_ == 0) longest_wait_ = std::max(longest_wait_, substeps / 4);
  return longest_wait_ - substeps_;
}

void Recovery::waited(long substeps, const Matrix3& strain) {
  substeps_ += substeps;
  Matrix3 shear = strain;
  for (int k = 0; k < dimension_; ++k) shear(k, k) -= strain.trace() / dimension_;
  sheared_ += shear.norm();
}

void Recovery::looked(double coordination, const Matrix3& last_strain) {
  if (longest_wait_ >= 0) return;
  const std::string off = "a held stress is off by " + in_words(error_) + " of its scale: the grains cannot carry it, ";
  if (coordination == 0 && last_strain.trace() > 0)
    throw IncrementFailed(off + "for it pulls at them and none touches another; give one that presses them together");
  if (sheared_ > flow)
    throw IncrementFailed(off + "for the cell sheared by " + in_words(sheared_) +
                          " while the target waited; give a smaller one, or prescribe the strain");
  if (!under_way_) return;
  growth_ = coordination < apart && error_ > gone ? std::min(growth_per_look * growth_, most_growth)
                                                  : std::max(1.0, 0.5 * growth_);
}

}  // namespace rvelab
