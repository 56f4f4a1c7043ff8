// Runs cases, each in a process of its own with limits on processor time and memory, several at a time.
#pragma once

#include <vector>

#include "tests/extreme/matrix.hpp"

namespace rvelab::test {

struct Result {
  const Case* asked = nullptr;
  Answer answer;
  double seconds = 0;  ///< processor time
};

/// All results, in the order of the cases. A process that crashes, hangs or runs out of memory is a result, WRONG.
std::vector<Result> run(const std::vector<Case>& cases, unsigned at_a_time = 1);

}  // namespace rvelab::test
