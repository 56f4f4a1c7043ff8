// One line on a terminal that shows how a test is getting on; nothing in a pipe or a file.
#pragma once

#include <chrono>

#include "rvelab/protocol/run.hpp"

namespace rvelab::cli {

/// Writes to standard error, over itself, at most five times a second, and wipes itself away at the end.
class ProgressLine {
 public:
  ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();

  /// Stage, strain, stress ratio q/p, grain-steps per second, time left (from the records made and still to make).
  void show(const Moment& moment);

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  bool shown_ = false;
  bool begun_ = false;
  Clock::time_point begin_, last_;
  std::uint64_t first_grain_steps_ = 0;
  std::size_t first_records_ = 0;
};

}  // namespace rvelab::cli
