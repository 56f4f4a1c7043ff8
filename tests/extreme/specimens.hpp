// The small specimens of the stress test (rvelab/stress_test/specimens.hpp) for tests, and what tests ask of refusals.
#pragma once

#include <string>

#include "rvelab/stress_test/specimens.hpp"

namespace rvelab::test {

using namespace rvelab::stress_test;

/// The message of an exception of type E that `work` throws; empty if it throws none.
template <class E, class Work>
std::string refusal(Work work) {
  try {
    work();
  } catch (const E& error) {
    return error.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace rvelab::test
