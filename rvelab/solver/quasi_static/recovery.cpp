#include "rvelab/solver/quasi_static/recovery.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "rvelab/error.hpp"

namespace rvelab {

using namespace constants;

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
  // In stiff packings the increment itself takes thousands of sub-steps, and transients decay as slowly.
  if (substeps_ == 0) longest_wait_ = std::max(longest_wait_, substeps / share_of_wait);
  return longest_wait_ - substeps_;
}

void Recovery::waited(long substeps, const Matrix3& strain) {
  substeps_ += substeps;
  Matrix3 shear = strain;
  for (int k = 0; k < dimension_; ++k) shear(k, k) -= strain.trace() / dimension_;
  sheared_ += shear.norm();
}

void Recovery::checked(double coordination, const Matrix3& last_strain) {
  if (longest_wait_ >= 0) return;
  const std::string off = "a held stress is off by " + in_words(error_) + " of its scale: the grains cannot carry it, ";
  if (coordination == 0 && last_strain.trace() > 0)
    throw IncrementFailed(off + "for it pulls at them and none touches another; give one that presses them together");
  if (sheared_ > shear_of_flow)
    throw IncrementFailed(off + "for the cell sheared by " + in_words(sheared_) +
                          " while the target waited; give a smaller one, or prescribe the strain");
  if (!under_way_) return;
  growth_ = coordination < contacts_apart && error_ > stress_gone
                ? std::min(largest_change_of_step * growth_, most_growth_of_closing)
                : std::max(1.0, 0.5 * growth_);
}

}  // namespace rvelab
