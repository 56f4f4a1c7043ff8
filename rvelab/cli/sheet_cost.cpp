#include "rvelab/cli/sheet_cost.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "rvelab/cli/progress_line.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::cli {

namespace fs = std::filesystem;

SheetCost::SheetCost(std::vector<Planned> tests, std::size_t first, std::size_t lanes, std::size_t processes)
    : tests_(std::move(tests)), first_(first), lanes_(lanes), processes_(processes) {
  for (std::size_t k = 0; k < tests_.size(); ++k) done_.push_back(complete(k));
}

bool SheetCost::complete(std::size_t test) const {
  return fs::exists(tests_[test].file) && !fs::exists(io::journal_of(tests_[test].file));
}

void SheetCost::begins(std::size_t test) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  Begun& here = running_[std::this_thread::get_id()];
  // One that another process has in hand, or that was begun before, tells no time.
  if (here.whole && complete(here.test)) {
    const double seconds = std::chrono::duration<double>(now - here.when).count();
    of_variant_[tests_[here.test].variant].add(seconds);
    all_.add(seconds);
    if (all_.tests >= first_ && !told_) tell_rest();
  }
  here = {test, now, !fs::exists(tests_[test].file) && !fs::exists(io::journal_of(tests_[test].file))};
}

void SheetCost::tell_rest() {
  told_ = true;
  double rest = -double(processes_) * all_.seconds;
  std::size_t left = 0;
  for (std::size_t k = 0; k < tests_.size(); ++k) {
    if (done_[k]) continue;
    const auto same = of_variant_.find(tests_[k].variant);
    rest += same != of_variant_.end() ? same->second.mean() : all_.mean();
    ++left;
  }
  const std::size_t lanes = lanes_ * processes_;
  left -= std::min(left, all_.tests * processes_);
  rest /= double(lanes);
  constexpr double worth_saying = 30;  // s
  if (rest < worth_saying) return;
  tell("the " + std::to_string(left) + " tests that are left take about " + duration_in_words(rest) + " on " +
       std::to_string(lanes) + (lanes == 1 ? " thread" : " threads") + ", since the first " +
       std::to_string(all_.tests) + " took " + in_words(std::round(10 * all_.mean()) / 10) +
       " s each; to shorten them: pack.number, sheet.seeds; Ctrl-C keeps what is done");
}

}  // namespace rvelab::cli
