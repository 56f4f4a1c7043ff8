// Numbers of a page have the digits that mean something.
#include "rvelab/report/words.hpp"

#include <limits>

#include "tests/catch.hpp"

using namespace rvelab::report;

TEST_CASE("a number without an error has three digits, powers of 1000 where it is long") {
  CHECK(in_three_digits(32.866) == "32.9");
  CHECK(in_three_digits(1.5e6) == "1.50e6");
  CHECK(in_three_digits(0.024) == "0.0240");
  CHECK(in_three_digits(12345) == "12300");
  CHECK(in_three_digits(99960) == "100e3");
  CHECK(in_three_digits(1.234e-5) == "12.3e-6");
  CHECK(in_three_digits(-0.5) == "\u22120.500");
  CHECK(in_three_digits(0) == "0");
  CHECK(in_three_digits(std::numeric_limits<double>::quiet_NaN()) == "-");
}

TEST_CASE("a mean has the digits that its standard error leaves it") {
  CHECK(with_its_error(30.8312, 0.4411) == "30.83 \u00b1 0.44");
  CHECK(with_its_error(11.913e6, 0.49e6) == "(11.91 \u00b1 0.49)e6");
  CHECK(with_its_error(30.8312, std::numeric_limits<double>::quiet_NaN()) == "30.8");
  CHECK(interval_in_words(29.8312, 31.8312) == "29.8 to 31.8");
  CHECK(fitting_unit(11.9e6, "Pa").unit == "MPa");
  CHECK(fitting_unit(11.9e3, "Pa").unit == "kPa");
}
