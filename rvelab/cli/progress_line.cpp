#include "rvelab/cli/progress_line.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "rvelab/io/utf8.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::cli {
namespace {

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// Strain of the last record of the present stage, and q/p.
std::string state_of(const protocol::PathPoint& reached) {
  const records::TestResult& result = reached.result;
  std::string text;
  char part[64];
  if (!result.records.empty() && result.records.back().stage == reached.progress.stage) {
    std::snprintf(part, sizeof part, "  strain %.2f %%", 100 * result.records.back().strain);
    text += part;
  }
  const int dimension = reached.rve.cell().dimension;
  const double p = mean_pressure(reached.progress.stress, dimension);
  if (p > 0) {
    std::snprintf(part, sizeof part, "  q/p %.3f", deviatoric_stress(reached.progress.stress, dimension) / p);
    text += part;
  }
  return text;
}

std::string speed_of(double grain_steps, double seconds) {
  char part[64];
  std::snprintf(part, sizeof part, "  %.1f M grain-steps/s", grain_steps / seconds / 1e6);
  return part;
}

}  // namespace

std::string duration_in_words(double seconds) {
  const auto whole = long(std::ceil(seconds));
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

TerminalLine::TerminalLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

TerminalLine::~TerminalLine() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void TerminalLine::write(const std::string& line) {
  if (!terminal_) return;
  const std::lock_guard lock(mutex_);
  const std::string text = io::printable(line);
  std::size_t end = 0;  // between two characters
  for (std::size_t at = 0; at < text.size() && at < terminal_width() - 1;) {
    at += std::max<std::size_t>(1, io::utf8_length(text, at));
    if (at <= terminal_width() - 1) end = at;
  }
  std::fprintf(stderr, "\r%s\033[K", text.substr(0, end).c_str());
  std::fflush(stderr);
  shown_ = true;
}

void TerminalLine::write_at_times(const std::string& line) {
  {
    const std::lock_guard lock(mutex_);
    if (!terminal_ || Clock::now() - last_ < std::chrono::milliseconds(200)) return;
    last_ = Clock::now();
  }
  write(line);
}

void ProgressReport::show(const protocol::PathPoint& reached) {
  const auto& records = reached.result.records;
  const auto now = Clock::now();
  if (records.size() <= told_ || std::chrono::duration<double>(now - last_).count() < 0.2) return;
  last_ = now;
  told_ = records.size();
  std::fprintf(stderr, "progress {\"records\": %zu, \"stage\": %d, \"strain\": %.17g}\n", told_, records.back().stage,
               records.back().strain);
  std::fflush(stderr);
}

void ProgressLine::done(std::size_t number) {
  const std::lock_guard lock(mutex_);
  Test& test = tests_[number];
  test.part = 1;
  if (!test.begun) test.first_part = 1;  // was complete before
  test.finished = true;
}

void ProgressLine::show(std::size_t number, const std::string& name, const protocol::PathPoint& reached) {
  if (!line_.on_terminal()) return;
  const std::lock_guard lock(mutex_);
  Test& test = tests_[number];
  const records::TestResult& result = reached.result;
  test.part = reached.records_planned == 0
                  ? 0.0
                  : std::min(1.0, double(result.records.size()) / double(reached.records_planned));
  if (!test.begun) {
    test.begun = true;
    test.first_part = test.part;
    test.first_grain_steps = reached.rve.grain_steps();
  }
  test.grain_steps = double(reached.rve.grain_steps() - test.first_grain_steps);
  const auto stage = std::size_t(reached.progress.stage);
  const std::string stage_name = stage < result.stages.size() ? result.stages[stage] : std::string("done");
  write_line((name.empty() ? stage_name : name) + state_of(reached));
}

void ProgressLine::show(std::size_t number, const std::string& name, double part, double grain_steps) {
  if (!line_.on_terminal()) return;
  const std::lock_guard lock(mutex_);
  Test& test = tests_[number];
  test.begun = true;
  test.part = part;
  test.grain_steps = grain_steps;
  write_line(name);
}

void ProgressLine::write_line(const std::string& name) {
  const auto now = Clock::now();
  const auto seconds = [&](Clock::time_point since) { return std::chrono::duration<double>(now - since).count(); };
  if (seconds(last_) < 0.2) return;
  last_ = now;
  std::size_t finished = 0;
  double grain_steps = 0, part = 0, made = 0;
  for (const Test& each : tests_) {
    finished += each.finished ? 1 : 0;
    grain_steps += each.grain_steps;
    part += each.part;
    made += each.part - each.first_part;
  }
  const double to_make = double(tests_.size()) - part;
  const std::string left =
      made > 0 && to_make > 0 ? "  " + duration_in_words(seconds(begin_) / made * to_make) + " left" : std::string();
  const std::string speed = speed_of(grain_steps, seconds(begin_));
  if (tests_.size() == 1) return line_.write(name + speed + left);
  // The state of all tests comes first, because a narrow terminal cuts the end.
  line_.write(std::to_string(finished) + " of " + std::to_string(tests_.size()) + " " + noun_ + " done" + left + speed +
              "  " + name);
}

}  // namespace rvelab::cli
