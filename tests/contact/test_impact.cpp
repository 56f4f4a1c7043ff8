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

TEST_CASE("dashpots of any restitution are found: where the force ends, exp(-decay) of the speed is left") {
  // Overdamped, the contact ends after ln((z + r)/(z - r))/(2 r omega), r^2 = z^2 - 1: decay 2 z/r ln(z + r).
  for (const double restitution : {1e-3, 1e-8, 1e-20, 1e-100, 1e-300}) {
    const double zeta = damping_ratio(restitution, true), root = std::sqrt(zeta * zeta - 1);
    REQUIRE(std::isfinite(zeta));
    CHECK(zeta / root * 2 * std::log(zeta + root) == Approx(-std::log(restitution)).epsilon(1e-9));
  }
}
