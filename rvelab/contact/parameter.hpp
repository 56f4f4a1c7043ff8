// What a law declares: the numbers of a grain material that it reads, and what it makes of two grains. No standard
// library: step kernels include the laws.
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

/// One of a group of constants that materials carry for the laws that read it, as files store it.
template <class Group>
struct StoredConstant {
  const char* dataset;
  double Group::*value;
  const char* unit;
  bool left_out_at_zero = false;  ///< a file holds it only where a material has it
};

/// Constants of one contact: f_n and the current stiffnesses follow from them and the overlap.
struct ContactConstants {
  double kn = 0;            ///< of f_n: linear N/m, Hertz N/m^1.5, cones N/m^2
  double kt = 0;            ///< of k_t: N/m; hertz_mindlin and hertz_rough N/m^1.5, cones N/m^2
  double law_constant = 0;  ///< one more, of laws that have one
};

/// 2ab/(a + b), zero if either is zero.
static inline double harmonic_mean(double a, double b) { return a > 0 && b > 0 ? 2 * (a * b) / (a + b) : 0.0; }

}  // namespace rvelab
