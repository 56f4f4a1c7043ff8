#include "rvelab/protocol/runner.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "rvelab/error.hpp"

namespace rvelab::protocol {

namespace {

unsigned threads_for(unsigned threads, std::size_t most) {
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  return unsigned(std::min<std::size_t>(threads, most));
}

}  // namespace

Runner::Runner(const RunnerOptions& options, std::size_t most)
    : options_(options), team_(threads_for(options.threads, most)) {}

bool Runner::each(std::size_t count, const std::function<void(std::size_t)>& one) {
  std::atomic<bool> all{true};
  team_.for_each_in_turn(count, [&](std::size_t k) {
    if (stopped())
      all = false;
    else
      one(k);
  });
  return all;
}

Watch Runner::watch(std::size_t number, const std::string& name) const {
  Watch watch;
  watch.stop = options_.stop;
  if (options_.progress != nullptr)
    watch.on_path_point = [progress = options_.progress, number, name](const PathPoint& reached) {
      progress->show(number, name, reached);
    };
  return watch;
}

void Runner::show(std::size_t number, const std::string& name, double part, double grain_steps) const {
  if (options_.progress != nullptr) options_.progress->show(number, name, part, grain_steps);
}

void Runner::done(std::size_t number) const {
  if (options_.progress != nullptr) options_.progress->done(number);
}

std::vector<std::string> Runner::run(const std::vector<const PlannedTest*>& tests, const Take& take,
                                     const RunOne& run_one) {
  std::vector<std::string> failures(tests.size());
  each(tests.size(), [&](std::size_t k) {
    const PlannedTest& test = *tests[k];
    try {
      const Specimen specimen = test.specimen();
      TestRun run = run_one ? run_one(k, specimen, watch(k, test.name))
                            : run_protocol(*test.protocol, specimen, watch(k, test.name));
      if (!run.complete) return;
      done(k);
      take(k, std::move(run));
    } catch (const InputError& error) {
      throw InputError(test.name + ": " + error.what());
    } catch (const Error& error) {
      failures[k] = test.name + ": " + error.what();
    }
  });
  return failures;
}

}  // namespace rvelab::protocol
