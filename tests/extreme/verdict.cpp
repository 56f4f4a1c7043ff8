#include "tests/extreme/verdict.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

const char* name(Outcome outcome) {
  return outcome == Outcome::right ? "right" : outcome == Outcome::refused ? "refused" : "WRONG";
}

std::uint64_t hashed(std::uint64_t hash, std::uint64_t bits) {
  for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (bits >> 8 * byte & 0xff)) * 1099511628211u;
  return hash;
}

namespace {

/// A message that says what to do or what is allowed, not only what is wrong.
bool names_remedy(const std::string& message) {
  // The words in which the library says what to do, or what would do.
  for (const char* word : {"solver.", "smaller", "must be", "allowed", "allows", "use ", "take ", "give ", "apply ",
                           "compress less", "start ", "correct ", "set ", "choose ", "leave ", "needs "})
    if (contains(message, word)) return true;
  return false;
}

}  // namespace

void Verdict::Worst::take(const std::string& name, double measured, double allowed) {
  double found = measured == 0 ? 0 : measured / allowed;
  if (!(found >= 0)) found = std::numeric_limits<double>::infinity();  // NaN, or a negative measure
  if (found <= error) return;
  error = found;
  char numbers[80];
  std::snprintf(numbers, sizeof numbers, ": %.3g, allowed %.3g", measured, allowed);
  what = name + numbers;
}

void Verdict::law(const std::string& what, double measured, double allowed) { laws_.take(what, measured, allowed); }

void Verdict::agreement(const std::string& what, double measured, double allowed) {
  agreements_.take(what, measured, allowed);
}

void Verdict::bits(std::uint64_t value) { hash_ = hashed(hash_.value_or(empty_hash), value); }

void Verdict::bits(const Matrix3& value) {
  for (int k = 0; k < 9; ++k) bits(std::bit_cast<std::uint64_t>(value(k / 3, k % 3)));
}

void Verdict::refusal(const std::string& what, const std::optional<Refused>& found) {
  law(what + " is refused", found.has_value());
  if (!found) return;
  law(what + ": the state is as it was", found->unchanged);
  law(what + ": the refusal names a remedy (" + found->text + ")", names_remedy(found->text));
  refusal_ = found->text;
}

Answer Verdict::answer(bool may_flag) const {
  Answer answer;
  answer.hash = hash_;
  const Worst& worst = laws_.error >= agreements_.error ? laws_ : agreements_;
  if (worst.error < 0) {
    answer.status = "the experiment measured nothing";
    return answer;
  }
  answer.error = worst.error;
  const bool excused = agreements_.error > 1 && flagged_ && may_flag;
  if (laws_.error > 1 || (agreements_.error > 1 && !excused)) {
    answer.status = (flagged_ ? "flagged; " : "") + worst.what;
    return answer;
  }
  answer.outcome = refusal_.empty() ? Outcome::right : Outcome::refused;
  if (excused) answer.status = "flagged; " + agreements_.what;
  if (!refusal_.empty()) answer.status = refusal_;
  return answer;
}

Answer Verdict::answer(const Refused& refused, bool may_refuse) const {
  Answer answer;
  answer.status = "refused: " + refused.text;
  const double worst = std::max(laws_.error, agreements_.error);
  if (worst >= 0) answer.error = worst;
  if (!refused.unchanged) {
    answer.status = "the state is changed by a refusal: " + refused.text;
  } else if (worst > 1) {
    answer.status = (laws_.error >= agreements_.error ? laws_ : agreements_).what + "; then refused: " + refused.text;
  } else if (!names_remedy(refused.text)) {
    answer.status = "refused without a remedy: " + refused.text;
  } else if (may_refuse) {
    answer.outcome = Outcome::refused;
  }
  return answer;
}

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
  constexpr std::size_t snapshots_up_to = 20'000;  // beyond, one would cost more than the increment
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

void Tested::check_momentum() {
  verdict_->law("momentum is zero, of sum m |v'|", net_momentum(rve_).norm() / momentum_scale(rve_), 1e-10);
}

}  // namespace rvelab::test
