// A number of a grain material that a contact law reads, as the law declares it. No standard library: step kernels
// include the laws.
#pragma once

namespace rvelab {

/// Values that a number may take.
struct Interval {
  double low, high;
  bool low_open = false, high_open = false;
  constexpr bool contains(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
  }
};

constexpr double no_bound = __builtin_inf();
constexpr Interval positive_number{0, no_bound, true, true};
constexpr Interval number_from_zero{0, no_bound, false, true};

/// `key`, as files write it, ends in its unit; `field` is the member's name.
struct Parameter {
  const char *key, *field, *unit;
  Interval allowed;
  const char *meaning, *remedy;
};

/// One of a group of constants that materials carry for the laws that read it, as files store it. `since`: the minor
/// version of files from which on they have it.
template <class Group>
struct StoredConstant {
  const char* dataset;
  double Group::*value;
  const char* unit;
  int since = 0;
};

}  // namespace rvelab
