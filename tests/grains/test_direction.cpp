// Directions from angles, without the functions of libm.
#include "rvelab/grains/direction.hpp"

#include "tests/catch.hpp"

TEST_CASE("A direction is the cosine and the sine of its angle, of length 1") {
  for (double degrees = -360; degrees <= 360; degrees += 0.37) {
    const auto [x, y] = rvelab::direction_of(degrees);
    const double radians = degrees * (3.14159265358979323846 / 180);
    CAPTURE(degrees);
    CHECK(std::abs(x - std::cos(radians)) < 2e-14);
    CHECK(std::abs(y - std::sin(radians)) < 2e-14);
    // Squares, sum, root and division, then squares and sum here: at most eight roundings of 2^-53.
    CHECK(std::abs(x * x + y * y - 1) <= std::ldexp(8.0, -53));
  }
  CHECK(rvelab::direction_of(0)[0] == 1);
  CHECK(rvelab::direction_of(0)[1] == 0);
}
