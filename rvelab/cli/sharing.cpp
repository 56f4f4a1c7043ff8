#include "rvelab/cli/sharing.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "rvelab/cli/interrupt.hpp"
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

enum class State { open, elsewhere, over };

/// Runs a test unless it is complete or another process has it.
State taken(const KeptTest& test, const TestOptions& options) {
  try {
    const Specimen specimen = test.specimen();
    const auto store = open_store(test.file, *test.protocol, specimen, options);
    protocol::Watch watch;
    watch.stop = &stop_on_signals();
    return run_recorded(*test.protocol, specimen, store.get(), watch).complete ? State::over : State::open;
  } catch (const io::Busy&) {
    return State::elsewhere;
  } catch (const InputError&) {
    throw;
  } catch (const Error&) {
    return State::over;  // the first rank meets the same failure and tells it
  }
}

}  // namespace

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

bool shared_out(const std::vector<KeptTest>& tests, bool kept, TestOptions& options) {
  const Ranks ranks = launched_ranks();
  if (ranks.count == 1) return true;
  const std::string who = std::to_string(ranks.count) + " ranks share the tests by their record files";
  if (!kept) throw InputError(who + "; allowed: with -o; name a folder that all of them see");
  if (options.force)
    throw InputError(who +
                     ", and each would overwrite with --force what another has done; allowed: a new folder, or "
                     "the one of the same tests, which then go on");
  options.resume = true;
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  Workers workers(options.threads > 0 ? options.threads : std::max(1u, cores / ranks.on_machine));
  std::vector<State> states(tests.size(), State::open);
  const std::size_t first = tests.size() * ranks.rank / ranks.count;  // ranks begin apart
  while (true) {
    workers.run(tests.size(), [&](std::size_t k) {
      const std::size_t at = (first + k) % tests.size();
      if (states[at] != State::over && !stop_on_signals().load()) states[at] = taken(tests[at], options);
    });
    if (ranks.rank > 0) return false;
    // The first rank stays to the end, and takes over what a rank that ended early leaves.
    const bool waits = std::find(states.begin(), states.end(), State::elsewhere) != states.end();
    if (!waits || stop_on_signals().load()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

}  // namespace rvelab::cli
