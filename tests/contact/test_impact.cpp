// The fifth root that sets the sub-step of Hertz collisions.
#include <cmath>

#include "rvelab/contact/impact.hpp"
#include "tests/catch.hpp"

using namespace rvelab;

TEST_CASE("the fifth root is right to a few of the last bits, and exact in powers of two") {
  for (double x = 1e-300; x < 1e300; x *= 7.3) {
    const double root = fifth_root(x);
    CHECK(std::abs(root * root * root * root * root / x - 1) < 4e-15);
    CHECK(fifth_root(std::ldexp(x, 10)) == 4 * root);
  }
  CHECK(fifth_root(0) == 0);
  CHECK(fifth_root(32) == 2);
}
