// Tests side by side: specimens by pressures by settings, shared out over threads, watched, and stopped together. Who
// plans them (calibrate, ensemble, fit, study) says what they are and what becomes of their results.
#pragma once

#include <limits>

#include "rvelab/protocol/run.hpp"
#include "rvelab/threads/workers.hpp"

namespace rvelab::protocol {

/// Shows how far tests are, each by its number, from 0. Called from any thread.
class Progress {
 public:
  virtual ~Progress() = default;
  virtual void show(std::size_t number, const std::string& name, const PathPoint& reached) = 0;
  /// The same for other work: the part of it that is done, 0 to 1, and its grain-steps since it began.
  virtual void show(std::size_t number, const std::string& name, double part, double grain_steps) = 0;
  virtual void done(std::size_t number) = 0;
};

struct RunnerOptions {
  unsigned threads = 0;                     ///< tests at a time; 0: one per core
  const std::atomic<bool>* stop = nullptr;  ///< once true no test begins, and those under way end
  Progress* progress = nullptr;
};

struct PlannedTest {
  std::string name;  ///< in messages and progress
  const Protocol* protocol = nullptr;
  std::function<Specimen()> specimen;  ///< made or read when the test begins
};

class Runner {
 public:
  /// Of no more than `most` tests at a time.
  explicit Runner(const RunnerOptions& options, std::size_t most = std::numeric_limits<unsigned>::max());

  /// one(k) for each k below count, in their order. False: it was stopped, and some were not begun. An exception does
  /// not stop the others; that of the lowest k is thrown at the end.
  bool each(std::size_t count, const std::function<void(std::size_t)>& one);
  /// Of a test in `each`: stops it, and shows its progress.
  Watch watch(std::size_t number, const std::string& name) const;
  void show(std::size_t number, const std::string& name, double part, double grain_steps) const;
  void done(std::size_t number) const;

  using RunOne = std::function<TestRun(std::size_t number, const Specimen& specimen, const Watch& watch)>;
  using Take = std::function<void(std::size_t number, TestRun&& run)>;
  /// Runs all; `take` gets each that comes to its end, on the thread of the test. `run_one`: in the place of
  /// run_protocol. Returns why each could not be carried out, with its name; "" where it was, or was stopped. An
  /// InputError is thrown at the end, with the name of its test.
  std::vector<std::string> run(const std::vector<const PlannedTest*>& tests, const Take& take,
                               const RunOne& run_one = {});

 private:
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  RunnerOptions options_;
  Workers team_;
};

}  // namespace rvelab::protocol
