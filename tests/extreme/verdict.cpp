#include "tests/extreme/verdict.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>

namespace rvelab::test {

const char* name(Outcome outcome) {
  return outcome == Outcome::right ? "right" : outcome == Outcome::refused ? "refused" : "WRONG";
}

std::uint64_t hashed(std::uint64_t hash, std::uint64_t bits) {
  for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (bits >> 8 * byte & 0xff)) * 1099511628211u;
  return hash;
}

bool names_remedy(const std::string& message) {
  // The words in which the library says what to do, or what would do.
  for (const char* word : {"solver.", "smaller", "must be", "allowed", "allows", "use ", "take ", "give ", "apply ",
                           "compress less", "start ", "correct ", "set ", "choose ", "leave ", "needs "})
    if (message.find(word) != std::string::npos) return true;
  return false;
}

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

}  // namespace rvelab::test
