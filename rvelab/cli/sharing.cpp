#include "rvelab/cli/sharing.hpp"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/progress_line.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/threads/workers.hpp"

namespace rvelab::cli {
namespace {

/// A count from the environment; `otherwise` if it is not there.
unsigned count_of(const char* variable, unsigned otherwise) {
  const char* text = std::getenv(variable);
  unsigned value = otherwise;
  if (text != nullptr) std::from_chars(text, text + std::strlen(text), value);
  return value;
}

enum class State { open, elsewhere, complete, failed };

/// Runs a test unless it is complete or another process has it.
State taken(const RecordedTest& test, const TestOptions& options, const std::atomic<bool>& stop) {
  try {
    const Specimen specimen = test.specimen();
    const auto store = open_store(test.file, *test.protocol, specimen, options);
    protocol::Watch watch;
    watch.stop = &stop;
    return run_recorded(*test.protocol, specimen, store.get(), watch).complete ? State::complete : State::open;
  } catch (const io::Busy&) {
    return State::elsewhere;
  } catch (const Error&) {
    return State::failed;  // the first rank meets it again, and tells it
  }
}

}  // namespace

unsigned threads_of(const Ranks& ranks) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  cpu_set_t bound;
  const unsigned own = sched_getaffinity(0, sizeof bound, &bound) == 0 ? unsigned(CPU_COUNT(&bound)) : cores;
  return std::max(1u, own < cores ? own : cores / ranks.on_machine);
}

Ranks launched_ranks() {
  constexpr const char* launchers[][3] = {
      {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_LOCAL_SIZE"},
      {"PMI_RANK", "PMI_SIZE", "MPI_LOCALNRANKS"}};
  for (const auto& [rank, size, local] : launchers) {
    const Ranks ranks{count_of(rank, 0), count_of(size, 1), 0};
    if (ranks.count > 1 && ranks.rank < ranks.count)
      return {ranks.rank, ranks.count, std::max(1u, count_of(local, ranks.count))};
  }
  return {};
}

namespace {

/// With options.share: carries out what no other process has in hand. True on the first rank, once every test is
/// complete or has failed; it then reads them, and meets the failures again. False on other ranks, when nothing is left
/// for them to take. True at once without options.share.
bool shared_out(const std::vector<RecordedTest>& tests, const TestOptions& options) {
  if (!options.share) return true;
  const Ranks ranks = launched_ranks();
  const std::atomic<bool>& stop = stop_on_signals();
  const unsigned threads = options.threads > 0 ? options.threads : threads_of(ranks);
  Workers workers(unsigned(std::min<std::size_t>(threads, tests.size())));
  std::vector<State> states(tests.size(), State::open);
  const auto count = [&](State state) { return std::count(states.begin(), states.end(), state); };
  const std::size_t first = tests.size() * ranks.rank / ranks.count;  // ranks begin apart
  for (bool told = false;; told = true) {
    workers.for_each_in_turn(tests.size(), [&](std::size_t k) {
      State& state = states[(first + k) % tests.size()];
      if (state == State::open || state == State::elsewhere)
        if (!stop.load()) state = taken(tests[(first + k) % tests.size()], options, stop);
    });
    if (stop.load())
      end_stopped(" with " + std::to_string(count(State::complete)) + " of " + std::to_string(tests.size()) +
                  " tests complete; the same command goes on with them");
    if (ranks.rank > 0) return false;
    // The first rank stays to the end, and takes over what a process that ended early leaves.
    if (count(State::elsewhere) == 0) return true;
    if (!told)
      tell("waits for " + std::to_string(count(State::elsewhere)) + " tests that other processes have in hand");
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
}

/// As open_store; with options.share it waits where another process is just reading the file.
std::unique_ptr<io::RecordStore> open_shared_store(const std::string& path, const protocol::Protocol& protocol,
                                                   const Specimen& specimen, const TestOptions& options) {
  while (true) {
    try {
      return open_store(path, protocol, specimen, options);
    } catch (const io::Busy&) {
      if (!options.share || stop_on_signals().load()) throw;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

}  // namespace

std::optional<std::vector<std::string>> run_tests(const std::vector<RecordedTest>& tests, const TestOptions& options,
                                                  Opening opening, const protocol::Runner::Take& take) {
  if (!shared_out(tests, options)) return std::nullopt;
  std::vector<std::unique_ptr<io::RecordStore>> stores(tests.size());
  const auto open = [&](std::size_t k, const Specimen& specimen) {
    if (!tests[k].file.empty()) stores[k] = open_shared_store(tests[k].file, *tests[k].protocol, specimen, options);
  };
  if (opening == Opening::all_first)
    for (std::size_t k = 0; k < tests.size(); ++k) open(k, tests[k].specimen());
  std::vector<const protocol::PlannedTest*> planned;
  for (const RecordedTest& test : tests) planned.push_back(&test);
  std::atomic<std::size_t> complete{0};
  std::vector<std::string> failures;
  {
    ProgressLine progress(tests.size());
    protocol::Runner runner({options.threads, &stop_on_signals(), &progress}, tests.size());
    failures = runner.run(
        planned,
        [&](std::size_t k, protocol::TestRun&& run) {
          take(k, std::move(run));
          ++complete;
        },
        [&](std::size_t k, const Specimen& specimen, const protocol::Watch& watch) {
          if (opening == Opening::one_by_one) open(k, specimen);
          const auto store = std::move(stores[k]);  // closed with the test
          return run_recorded(*tests[k].protocol, specimen, store.get(), watch);
        });
  }
  const auto failed = std::size_t(
      std::count_if(failures.begin(), failures.end(), [](const std::string& failure) { return !failure.empty(); }));
  if (complete + failed < tests.size())
    end_stopped(" with " + std::to_string(complete) + " of " + std::to_string(tests.size()) + " tests complete; " +
                (tests.front().file.empty() ? "their records are not kept without -o" : "continue with --resume"));
  return failures;
}

}  // namespace rvelab::cli
