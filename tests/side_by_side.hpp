// Tests at several pressures, several at a time.
#pragma once

#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/protocol/runner.hpp"

namespace rvelab::test {

/// Protocol k on specimen k, or on the only one.
inline std::vector<protocol::TestRun> run_all(const std::vector<protocol::Protocol>& protocols,
                                              const std::vector<Specimen>& specimens, unsigned threads) {
  std::vector<protocol::PlannedTest> tests;
  for (std::size_t k = 0; k < protocols.size(); ++k)
    tests.push_back({"p = " + in_words(protocols[k].pressure) + " Pa", &protocols[k],
                     [&specimens, k] { return specimens[specimens.size() == 1 ? 0 : k]; }});
  std::vector<const protocol::PlannedTest*> planned;
  for (const auto& test : tests) planned.push_back(&test);
  std::vector<protocol::TestRun> runs(tests.size());
  const auto failures =
      protocol::Runner({.threads = threads}, tests.size()).run(planned, [&](std::size_t k, protocol::TestRun&& run) {
        runs[k] = std::move(run);
      });
  for (const std::string& failure : failures)
    if (!failure.empty()) throw Error(failure);
  return runs;
}

}  // namespace rvelab::test
