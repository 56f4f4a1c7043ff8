// Runs cases, each in a process of its own with limits on time and memory, several at a time.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "rvelab/stress_test/matrix.hpp"
#include "rvelab/stress_test/verdict.hpp"

namespace rvelab::stress_test {

struct Result {
  const Case* asked = nullptr;
  Answer answer;
  double seconds = 0;  ///< processor time of the child
};

struct Running {
  /// The command that runs one case and prints its answer; the name of the case is put behind it.
  std::vector<std::string> command;
  unsigned jobs = 1;
  const std::atomic<bool>* stop = nullptr;       ///< children are killed and Interrupted is thrown once it is true
  std::function<void(const Result&)> on_result;  ///< in the order of the cases
};

/// All results, in the order of the cases. A child that crashes, hangs or runs out of memory is a result (WRONG), never
/// an error.
std::vector<Result> run(const std::vector<Case>& cases, const Running& running);

}  // namespace rvelab::stress_test
