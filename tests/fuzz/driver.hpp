// Many inputs through one check, in child processes, so that a crash or an endless run is one finding and not the end.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/fuzz/formats.hpp"

namespace rvelab::fuzz {

struct Finding {
  std::string what, file;  ///< the input is kept in the file
};

struct Tally {
  std::uint64_t executions = 0, taken = 0, refused = 0;
  std::vector<Finding> findings;
  double seconds = 0;
};

/// The seeds, then so many mutations of them, numbered from 0: the same number is the same input. With `seconds` > 0
/// as many as that time allows instead. Findings are written to `folder`; after twenty it stops.
Tally run(const Format& format, std::uint64_t mutations, double seconds, const std::string& folder);

/// The input of a number.
Bytes input_of(const Format& format, const std::vector<Bytes>& seeds, std::uint64_t number);

}  // namespace rvelab::fuzz
