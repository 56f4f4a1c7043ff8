// The values that a number may take, as messages print them.
#pragma once

#include <string>

#include "rvelab/contact/parameter.hpp"
#include "rvelab/error.hpp"

namespace rvelab {

/// "above 0 to below 1", ">= 0".
inline std::string in_words(const Interval& i) {
  TextStream words;
  if (i.low == -no_bound && i.high == no_bound)
    words << "any finite number";
  else if (i.low == -no_bound)
    words << (i.high_open ? "below " : "up to ") << i.high;
  else if (i.high == no_bound)
    words << (i.low_open ? "> " : ">= ") << i.low;
  else
    words << (i.low_open ? "above " : "") << i.low << " to " << (i.high_open ? "below " : "") << i.high;
  return words.str();
}

}  // namespace rvelab
