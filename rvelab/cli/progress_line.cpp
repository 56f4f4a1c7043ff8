#include "rvelab/cli/progress_line.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "rvelab/measure/measures.hpp"

namespace rvelab::cli {
namespace {

std::string in_words(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  char text[64];
  if (whole < 60) {
    std::snprintf(text, sizeof text, "%ld s", whole);
  } else if (whole < 3600) {
    std::snprintf(text, sizeof text, "%ld min %02ld s", whole / 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
  }
  return text;
}

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::show(const Moment& moment) {
  if (!terminal_) return;
  const auto now = Clock::now();
  const auto seconds = [&](Clock::time_point since) { return std::chrono::duration<double>(now - since).count(); };
  const TestResult& result = moment.result;
  if (!begun_) {
    begun_ = true;
    begin_ = last_ = now;
    first_grain_steps_ = moment.rve.grain_steps();
    first_records_ = result.records.size();
    return;
  }
  if (seconds(last_) < 0.2) return;
  last_ = now;

  const auto stage = static_cast<std::size_t>(moment.progress.stage);
  std::string text = stage < result.stages.size() ? result.stages[stage] : std::string("done");
  const bool recorded = !result.records.empty() && result.records.back().stage == moment.progress.stage;
  char part[128];
  if (recorded) {
    std::snprintf(part, sizeof part, "  strain %.2f %%", 100 * result.records.back().strain);
    text += part;
  }
  const int dimension = moment.rve.cell().dimension;
  const double p = mean_pressure(moment.progress.stress, dimension);
  if (p > 0) {
    std::snprintf(part, sizeof part, "  q/p %.3f", deviatoric_stress(moment.progress.stress, dimension) / p);
    text += part;
  }
  const double speed = static_cast<double>(moment.rve.grain_steps() - first_grain_steps_) / seconds(begin_);
  std::snprintf(part, sizeof part, "  %.1f M grain-steps/s", speed / 1e6);
  text += part;
  const std::size_t made = result.records.size() - first_records_;
  if (made > 0 && moment.records_planned > result.records.size()) {
    const auto to_make = static_cast<double>(moment.records_planned - result.records.size());
    text += "  " + in_words(seconds(begin_) / static_cast<double>(made) * to_make) + " left";
  }
  text.resize(std::min(text.size(), terminal_width() - 1));
  std::fprintf(stderr, "\r%s\033[K", text.c_str());
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace rvelab::cli
