// The values that a number may take, and how messages say them.
#pragma once

#include <string>

namespace rvelab::keys {

/// Interval of the values that a number may take.
struct Range {
  double low, high;
  bool low_open = false, high_open = false;
  bool contains(double value) const;
  std::string in_words() const;
};

}  // namespace rvelab::keys
