// One line on a terminal that shows the progress of work; nothing in a pipe or a file.
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "rvelab/protocol/runner.hpp"

namespace rvelab::cli {

using Clock = std::chrono::steady_clock;

/// "40 s", "3 min 05 s", "2 h 10 min".
std::string duration_in_words(double seconds);

/// A line on standard error that is overwritten, and removed at the end.
class TerminalLine {
 public:
  TerminalLine();
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;
  ~TerminalLine();
  /// From any thread. Cut to the width of the terminal.
  void write(const std::string& line);
  /// The same, at most five times a second.
  void write_at_times(const std::string& line);
  bool on_terminal() const { return terminal_; }

 private:
  const bool terminal_;
  bool shown_ = false;
  std::mutex mutex_;
  Clock::time_point last_{};
};

/// The progress of one test for a program that reads it: at most five times a second a line of standard error,
/// "progress " and a JSON object of the records made, the stage by its number from 0 and its driving strain at the last
/// record.
class ProgressReport {
 public:
  void show(const protocol::PathPoint& reached);

 private:
  Clock::time_point last_{};
  std::size_t told_ = 0;  ///< records
};

/// The line of one test: stage, strain, stress ratio q/p, grain-steps per second, time left. Of several at a time: how
/// many are done, time left, grain-steps per second of all, and the state of the one that reported last. At most five
/// times a second. May be called from any thread.
class ProgressLine : public protocol::Progress {
 public:
  /// `noun`: what the line calls them.
  explicit ProgressLine(std::size_t tests = 1, std::string noun = "tests") : noun_(std::move(noun)), tests_(tests) {}

  /// `name` of the test by its number, from 0; "": its stage.
  void show(std::size_t number, const std::string& name, const protocol::PathPoint& reached) override;
  void show(std::size_t number, const std::string& name, double part, double grain_steps) override;
  void done(std::size_t number) override;

 private:
  struct Test {
    double part = 0;                      ///< of its records, 0 to 1
    double first_part = 0;                ///< that was there when it began (a resumed test)
    std::uint64_t first_grain_steps = 0;  ///< of its specimen when it began
    double grain_steps = 0;               ///< made since
    bool begun = false, finished = false;
  };
  /// Writes the line if it is time; needs the lock.
  void write_line(const std::string& name);

  TerminalLine line_;
  const std::string noun_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
  std::vector<Test> tests_;
  std::mutex mutex_;
};

}  // namespace rvelab::cli
