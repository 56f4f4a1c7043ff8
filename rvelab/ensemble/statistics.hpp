// Mean, scatter and intervals of values that specimens of one kind give, and numbers written with their errors.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace rvelab::ensemble {

/// What a test does not tell.
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Of values that are defined (not NaN); all NaN but n where there are none, and all but n and mean of a single one.
struct Spread {
  std::size_t n = 0;
  double mean = 0;
  double standard_deviation = 0;  ///< divided by n - 1
  double standard_error = 0;      ///< of the mean
  double low = 0, high = 0;       ///< 95 % interval of the mean, Student's t with n - 1 degrees of freedom
};
Spread spread_of(const std::vector<double>& values);

/// Mean of one group less that of another, of unequal scatter (Welch 1947).
struct Difference {
  double value = 0;
  double standard_error = 0;
  double low = 0, high = 0;  ///< 95 % interval, Student's t with the degrees of freedom of Welch and Satterthwaite
};
Difference difference_of(const Spread& one, const Spread& other);

/// The t that Student's distribution of `freedom` > 0 degrees of freedom exceeds with a probability of 2.5 %.
double students_t(double freedom);

/// "30.12 +- 0.45": the error to two digits, the value to the same place; powers of 1000 where numbers are long:
/// "(25.7 +- 1.2)e6". Without an error (NaN, 0) four digits; "-" for NaN.
std::string with_error(double value, double error);
/// The value alone, with the digits that its error, or half of its interval, allows.
std::string in_digits_of(double value, double error);

}  // namespace rvelab::ensemble
