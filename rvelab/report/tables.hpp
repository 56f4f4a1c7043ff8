// The tables and sentences of a page about tests of one name.
#pragma once

#include <vector>

#include "rvelab/ensemble/summary.hpp"
#include "rvelab/report/test.hpp"

namespace rvelab::report {

/// Number of tests, pressures, stages with the keys of the protocol that say what was asked.
Table asked_of(const std::vector<Test>& tests, const std::vector<Kind>& kinds);

/// Grains, grading, cell, void ratio, contact law, materials of the first test.
Table specimen_of(const Test& test);

/// Every measure over the specimens of each set of tests, as `rvelab run` prints it; then the difference of two sets.
struct Results {
  ensemble::Summary summary;  ///< group k is set k
  Table means, differences;
};
Results results_of(const std::vector<Test>& tests, const std::vector<Kind>& kinds);
/// What tells a set of kinds from the others; "" where there is one.
std::vector<std::string> names_of_sets(const std::vector<Kind>& kinds);

/// Loops of cyclic stages: amplitude, shear modulus, damping; only the head where there is none.
Table loops_of(const std::vector<Test>& tests);

/// A row a test: records, doubtful ones, error estimate, run time.
Table errors_of(const std::vector<Test>& tests);
/// How large the errors of the stresses are, and where they are largest.
std::string errors_in_words(const std::vector<Test>& tests);

}  // namespace rvelab::report
