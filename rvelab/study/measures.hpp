// Measures of whole paths. Each is a number of a test; means over repeats are compared, since single paths of dense
// packings are chaotic.
//
// A new measure is a function in measures.cpp and its line in the table there; tables, files and figures follow.
#pragma once

#include <string>
#include <vector>

#include "rvelab/records/record.hpp"

namespace rvelab::study {

struct Measure {
  std::string name;  ///< ends in its unit
  std::string unit;  ///< "1": none
  std::string meaning;
  double (*of)(const records::TestResult& test, int dimension);  ///< NaN: the test does not give it
};

const std::vector<Measure>& measures();

}  // namespace rvelab::study
