// The tables and sentences of a page about tests of one name.
#pragma once

#include <vector>

#include "rvelab/ensemble/summary.hpp"
#include "rvelab/report/test.hpp"

namespace rvelab::report {

/// Number of tests, pressures, stages with their keys of the protocol.
Table asked_of(const std::vector<Test>& tests, const std::vector<Kind>& kinds);

/// Grains, grading, cell, void ratio, contact law, materials of the first test.
Table specimen_of(const Test& test);

/// Every measure over the specimens of each set of tests, as `rvelab run` prints it; then the difference of two sets.
struct Results {
  ensemble::Summary summary;  ///< group k is set k
  Table means, differences;
};
Results results_of(const std::vector<Test>& tests, const std::vector<Kind>& kinds);
/// The distinguishing label of a set of kinds; "" if there is only one.
std::vector<std::string> names_of_sets(const std::vector<Kind>& kinds);

/// Loops of cyclic stages: amplitude, shear modulus, damping; only the head if there are none.
Table loops_of(const std::vector<Test>& tests);

/// One row per test: records, flagged ones, error estimate, run time.
Table errors_of(const std::vector<Test>& tests);
/// Errors of the stresses, and the record with the largest.
std::string errors_in_words(const std::vector<Test>& tests);

}  // namespace rvelab::report
