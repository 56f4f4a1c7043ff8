#include "rvelab/keys/range.hpp"

#include <limits>
#include <sstream>

namespace rvelab::keys {

bool Range::contains(double value) const {
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Range::in_words() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::ostringstream words;
  if (low == -infinity && high == infinity) {
    words << "any finite number";
  } else if (low == -infinity) {
    words << (high_open ? "below " : "up to ") << high;
  } else if (high == infinity) {
    words << (low_open ? "> " : ">= ") << low;
  } else {
    words << (low_open ? "above " : "") << low << " to " << (high_open ? "below " : "") << high;
  }
  return words.str();
}

}  // namespace rvelab::keys
