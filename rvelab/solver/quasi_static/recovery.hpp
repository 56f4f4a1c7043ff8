// Waiting for a held stress in quasi-static loading. In an avalanche the contact network gives way and the stress that
// is held falls, to nothing where the cell comes apart. The strained directions then stand still until it is back.
//
// How fast the cell may close meanwhile follows from the contacts that the grains will have, not from those that are
// left: by a few thousandths of their overlap a sub-step. Grains that meet at that speed overlap by as much (a sub-step
// is about a quarter of the period of a contact), and a network that jams is found by the servo within a few per cent
// of its stress. While no network is there the speed grows, or a cell of stiff grains would need millions of sub-steps.
#pragma once

#include <algorithm>
#include <limits>
#include <string>

#include "rvelab/error.hpp"
#include "rvelab/solver/loading/mixed_target.hpp"
#include "rvelab/solver/quasi_static/constants.hpp"

namespace rvelab {

class Recovery {
 public:
  /// `strain_of_overlap`: mean overlap over the diameter of grains that carry what is held.
  Recovery(const MixedTarget& target, double strain_of_overlap, int dimension)
      : tolerance_(target.tolerance),
        strain_of_overlap_(strain_of_overlap),
        dimension_(dimension),
        longest_wait_(target.wait) {}

  /// From the largest error of a held stress over its scale: begins where it is far beyond the tolerance, ends within
  /// it. Not where the target has a wait of its own.
  void judge(double error) {
    using namespace constants;
    if (longest_wait_ >= 0) return;
    error_ = error;
    if (error > std::max(far_off * tolerance_, least_far_off)) under_way_ = true;
    if (error > tolerance_) return;
    under_way_ = false;
    growth_ = 1;
    sheared_ = 0;
  }
  bool under_way() const { return under_way_; }

  /// Strain of a sub-step by which the cell may follow the stress.
  double closing() const { return constants::closing_over_overlap * growth_ * strain_of_overlap_; }

  /// Sub-steps that the target may wait yet, after so many in all.
  long patience(long substeps) {
    if (longest_wait_ < 0) return std::numeric_limits<long>::max();
    // In stiff packings the increment itself takes thousands of sub-steps, and transients decay as slowly.
    if (substeps_ == 0) longest_wait_ = std::max(longest_wait_, substeps / constants::share_of_wait);
    return longest_wait_ - substeps_;
  }
  /// Books sub-steps in which the target stood still, and the strain that the servo made in them.
  void waited(long substeps, const Matrix3& strain) {
    substeps_ += substeps;
    Matrix3 shear = strain;
    for (int k = 0; k < dimension_; ++k) shear(k, k) -= strain.trace() / dimension_;
    sheared_ += shear.norm();
  }
  long substeps() const { return substeps_; }

  /// After a check of the contacts: their number per grain, and the strain that the servo made last. Throws
  /// IncrementFailed where the grains cannot carry what is held: none touches another and the stress asks for more
  /// room, or the cell has sheared by a half while it waited.
  void checked(double coordination, const Matrix3& last_strain) {
    using namespace constants;
    if (longest_wait_ >= 0) return;
    const std::string off =
        "a held stress is off by " + in_words(error_) + " of its scale: the grains cannot carry it, ";
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

 private:
  double tolerance_, strain_of_overlap_;
  int dimension_;
  double error_ = 0, growth_ = 1, sheared_ = 0;
  long substeps_ = 0, longest_wait_;
  bool under_way_ = false;
};

}  // namespace rvelab
