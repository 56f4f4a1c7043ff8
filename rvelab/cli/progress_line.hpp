// One line on a terminal that shows the progress of a test; nothing in a pipe or a file.
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "rvelab/protocol/run.hpp"

namespace rvelab::cli {

/// A line on standard error, overwritten at most five times a second and removed at the end.
class ProgressLine {
 public:
  ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();

  /// Stage, strain, stress ratio q/p, grain-steps per second, time left (from the records made and still to make).
  void show(const protocol::Moment& moment);

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  bool shown_ = false;
  bool begun_ = false;
  Clock::time_point begin_, last_;
  std::uint64_t first_grain_steps_ = 0;
  std::size_t first_records_ = 0;
};

/// The same for several tests at a time: how many are done, the state of the one that reported last, grain-steps per
/// second of all, time left. May be called from any thread.
class ProgressOfTests {
 public:
  /// `noun`: what the line calls them.
  explicit ProgressOfTests(std::size_t tests, std::string noun = "tests");
  ProgressOfTests(const ProgressOfTests&) = delete;
  ProgressOfTests& operator=(const ProgressOfTests&) = delete;
  ~ProgressOfTests();

  /// `name` of the test by its number, from 0.
  void show(std::size_t number, const std::string& name, const protocol::Moment& moment);
  /// The same for other work: the part of it that is done, 0 to 1, and its grain-steps since it began.
  void show(std::size_t number, const std::string& name, double part, double grain_steps);
  void done(std::size_t number);

 private:
  using Clock = std::chrono::steady_clock;
  struct Test {
    double part = 0;                      ///< of its records, 0 to 1
    double first_part = 0;                ///< that was there when it began (a resumed test)
    std::uint64_t first_grain_steps = 0;  ///< of its specimen when it began
    double grain_steps = 0;               ///< made since
    bool begun = false, finished = false;
  };
  /// Writes the line if it is time; needs the lock.
  void write_line(const std::string& name);

  const bool terminal_;
  const std::string noun_;
  bool shown_ = false;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
  std::vector<Test> tests_;
  std::mutex mutex_;
};

}  // namespace rvelab::cli
