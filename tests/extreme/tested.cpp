#include "tests/extreme/tested.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

namespace {

/// Above so many grains a snapshot before each increment would cost more than the increment.
constexpr std::size_t snapshots_up_to = 20'000;

}  // namespace

std::optional<Refused> refused(Rve& rve, const std::function<void(Rve&)>& call) {
  const auto before = rve.save();
  try {
    call(rve);
  } catch (const Error& error) {
    return Refused{error.what(), rve.save() == before};
  }
  return std::nullopt;
}

Tested::Tested(const Specimen& specimen, Verdict& verdict)
    : rve_(specimen),
      verdict_(&verdict),
      volume_(rve_.cell().volume()),
      overlap_limit_(specimen.solver.max_overlap_ratio),
      grains_(rve_.size()) {}

template <class Increment>
Response Tested::made(const Increment& increment, double dt) {
  std::vector<std::byte> before;
  if (grains_ <= snapshots_up_to) before = rve_.save();
  try {
    last_ = rve_.apply(increment, dt);
  } catch (const Error& error) {
    throw Refused{error.what(), grains_ > snapshots_up_to || rve_.save() == before};
  }
  volume_ *= (Matrix3::Identity() + last_.displacement_gradient).determinant();
  ++increments_;
  substeps_ += last_.report.substeps;
  quasi_static_ = dt == 0;
  verdict_->note(last_.report);
  verdict_->bits(last_.stress);
  return last_;
}

Response Tested::apply(const Matrix3& displacement_gradient, double dt) { return made(displacement_gradient, dt); }
Response Tested::apply(const MixedTarget& target, double dt) { return made(target, dt); }

double Tested::pressure() const { return mean_pressure(rve_.stress(), rve_.cell().dimension); }

void Tested::check_laws() {
  constexpr double round_off = 2.3e-16;
  const double volume = rve_.cell().volume();
  // Products of n factors, each rounded a dozen times, in the worst case of one sign; an increment alone is the product
  // of as many parts as it has control updates, each of five sub-steps at least.
  verdict_->law("volume = V0 det F", std::abs(volume / volume_ - 1),
                1e-12 + round_off * (16 * double(increments_) + 0.2 * double(substeps_)));
  verdict_->law("no grain is lost", rve_.size() == grains_);
  const Network network = rve_.network();
  bool finite = last_.stress.allFinite();
  for (const GrainState& grain : network.grains)
    finite = finite && grain.position.allFinite() && grain.velocity.allFinite() && grain.spin.allFinite();
  verdict_->law("all places, velocities and stresses are numbers", finite);
  verdict_->law("overlap within the limit", largest_overlap_ratio(network), overlap_limit_);
  if (!quasi_static_ || increments_ == 0) return;
  const Matrix3 stress = rve_.stress();
  const double p = std::abs(mean_pressure(stress, network.dimension()));
  const double floor = std::max(p, 1e-3 * rve_.reference_pressure());  // as the unbalanced ratio has it
  verdict_->law("|sigma - sigma^T| <= 1.5 unbalanced p", largest(stress - stress.transpose()),
                1.5 * rve_.unbalanced_ratio() * floor + 1e-9 * floor);
}

}  // namespace rvelab::test
