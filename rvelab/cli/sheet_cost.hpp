// What a data sheet takes: told once the tests of a first specimen show it.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace rvelab::cli {

class SheetCost {
 public:
  /// `loadings`: of each test the number of its loading; tests that are complete already are left out (`done`).
  /// `first`: so many tests before anything is said. `lanes`: tests at a time of this process, one of `processes` that
  /// make as many each.
  SheetCost(std::vector<std::size_t> loadings, std::vector<bool> done, std::size_t first, std::size_t lanes,
            std::size_t processes);
  /// A test begins, on any thread; the one before on this thread has ended.
  void begins(std::size_t test);

 private:
  using Clock = std::chrono::steady_clock;
  struct Begun {
    std::size_t test = 0;
    Clock::time_point when;
  };
  struct Sum {
    double seconds = 0;
    std::size_t tests = 0;
    void add(double more) { seconds += more, ++tests; }
    double mean() const { return seconds / double(tests); }
  };
  void tell_rest();

  const std::vector<std::size_t> loadings_;
  const std::vector<bool> done_;  ///< before this run
  const std::size_t first_, lanes_, processes_;
  bool told_ = false;
  Sum all_;
  std::map<std::size_t, Sum> of_loading_;
  std::map<std::thread::id, Begun> running_;
  std::mutex mutex_;
};

}  // namespace rvelab::cli
