// What a data sheet takes: told once the tests of a first specimen show it.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace rvelab::cli {

class SheetCost {
 public:
  struct Planned {
    std::size_t variant = 0;  ///< tests of the same one take the same time
    std::string file;         ///< of its records
  };
  /// `first`: tests of which the time must be known before anything is said. `lanes`: tests at a time of this process,
  /// one of `processes` that make as many each.
  SheetCost(std::vector<Planned> tests, std::size_t first, std::size_t lanes, std::size_t processes);
  /// A test begins, on any thread; the one before on this thread has ended.
  void begins(std::size_t test);

 private:
  using Clock = std::chrono::steady_clock;
  struct Begun {
    std::size_t test = 0;
    Clock::time_point when;
    bool whole = false;  ///< nothing was there of it
  };
  struct Sum {
    double seconds = 0;
    std::size_t tests = 0;
    void add(double more) { seconds += more, ++tests; }
    double mean() const { return seconds / double(tests); }
  };
  bool complete(std::size_t test) const;
  void tell_rest();

  const std::vector<Planned> tests_;
  std::vector<bool> done_;  ///< before this run
  const std::size_t first_, lanes_, processes_;
  bool told_ = false;
  Sum all_;
  std::map<std::size_t, Sum> of_variant_;
  std::map<std::thread::id, Begun> running_;
  std::mutex mutex_;
};

}  // namespace rvelab::cli
