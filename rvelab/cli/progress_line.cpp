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

/// Overwrites the line, cut to the width of the terminal between two characters.
void write_over(const std::string& line) {
  const std::string text = io::printable(line);
  std::size_t end = 0;
  for (std::size_t at = 0; at < text.size() && at < terminal_width() - 1;) {
    at += std::max<std::size_t>(1, io::utf8_length(text, at));
    if (at <= terminal_width() - 1) end = at;
  }
  std::fprintf(stderr, "\r%s\033[K", text.substr(0, end).c_str());
  std::fflush(stderr);
}

void wipe() { std::fputs("\r\033[K", stderr); }

/// Strain of the last record of the present stage, and q/p.
std::string state_of(const protocol::Moment& moment) {
  const records::TestResult& result = moment.result;
  std::string text;
  char part[64];
  if (!result.records.empty() && result.records.back().stage == moment.progress.stage) {
    std::snprintf(part, sizeof part, "  strain %.2f %%", 100 * result.records.back().strain);
    text += part;
  }
  const int dimension = moment.rve.cell().dimension;
  const double p = mean_pressure(moment.progress.stress, dimension);
  if (p > 0) {
    std::snprintf(part, sizeof part, "  q/p %.3f", deviatoric_stress(moment.progress.stress, dimension) / p);
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

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shown_) wipe();
}

void ProgressLine::show(const protocol::Moment& moment) {
  if (!terminal_) return;
  const auto now = Clock::now();
  const auto seconds = [&](Clock::time_point since) { return std::chrono::duration<double>(now - since).count(); };
  const records::TestResult& result = moment.result;
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
  text += state_of(moment);
  text += speed_of(static_cast<double>(moment.rve.grain_steps() - first_grain_steps_), seconds(begin_));
  const std::size_t made = result.records.size() - first_records_;
  if (made > 0 && moment.records_planned > result.records.size()) {
    const auto to_make = static_cast<double>(moment.records_planned - result.records.size());
    text += "  " + in_words(seconds(begin_) / static_cast<double>(made) * to_make) + " left";
  }
  write_over(text);
  shown_ = true;
}

ProgressOfTests::ProgressOfTests(std::size_t tests, std::string noun)
    : terminal_(isatty(STDERR_FILENO) == 1), noun_(std::move(noun)), tests_(tests) {}

ProgressOfTests::~ProgressOfTests() {
  if (shown_) wipe();
}

void ProgressOfTests::done(std::size_t number) {
  const std::lock_guard lock(mutex_);
  Test& test = tests_[number];
  test.part = 1;
  if (!test.begun) test.first_part = 1;  // was complete before
  test.finished = true;
}

void ProgressOfTests::show(std::size_t number, const std::string& name, const protocol::Moment& moment) {
  if (!terminal_) return;
  const std::lock_guard lock(mutex_);
  Test& test = tests_[number];
  test.part = moment.records_planned == 0 ? 0.0
                                          : std::min(1.0, static_cast<double>(moment.result.records.size()) /
                                                              static_cast<double>(moment.records_planned));
  if (!test.begun) {
    test.begun = true;
    test.first_part = test.part;
    test.first_grain_steps = moment.rve.grain_steps();
  }
  test.grain_steps = static_cast<double>(moment.rve.grain_steps() - test.first_grain_steps);
  write_line(name + state_of(moment));
}

void ProgressOfTests::show(std::size_t number, const std::string& name, double part, double grain_steps) {
  if (!terminal_) return;
  const std::lock_guard lock(mutex_);
  Test& test = tests_[number];
  test.begun = true;
  test.part = part;
  test.grain_steps = grain_steps;
  write_line(name);
}

void ProgressOfTests::write_line(const std::string& name) {
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
  // The state of all tests comes first, because a narrow terminal cuts the end.
  std::string text = std::to_string(finished) + " of " + std::to_string(tests_.size()) + " " + noun_ + " done";
  const double to_make = static_cast<double>(tests_.size()) - part;
  if (made > 0 && to_make > 0) text += "  " + in_words(seconds(begin_) / made * to_make) + " left";
  text += speed_of(grain_steps, seconds(begin_)) + "  " + name;
  write_over(text);
  shown_ = true;
}

}  // namespace rvelab::cli
