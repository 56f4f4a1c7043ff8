// JKR and DMT against their equations and published limits.
#include <cmath>

#include "rvelab/interaction/adhesion.hpp"
#include "tests/catch.hpp"
#include "tests/specimens.hpp"

using namespace rvelab::interaction;
using rvelab::test::pi;

namespace {

constexpr double work = 0.14, modulus = 3.7e9, radius = 11e-6;  // J/m^2, Pa, m

double jkr_force_of(double a) {
  return 4 * modulus * a * a * a / (3 * radius) - std::sqrt(8 * pi * work * modulus * a * a * a);
}
double jkr_overlap_of(double a) { return a * a / radius - std::sqrt(2 * pi * work * a / modulus); }

}  // namespace

TEST_CASE("the cube root is right to the last bits", "[interaction]") {
  for (double x = 1e-300; x < 1e300; x *= 3.7) {
    const double root = cube_root(x);
    CHECK(std::abs(root * root * root / x - 1) < 1e-15);
  }
  CHECK(cube_root(27) == 3);
  CHECK(cube_root(0) == 0);
  for (double x = -1.5; x < 1.6; x += 0.1) CHECK(std::abs(cosine(x) - std::cos(x)) < 2e-16);
}

TEST_CASE("JKR: force and overlap of an area of contact obey the equations of 1971", "[interaction]") {
  const Jkr pair = jkr(work, modulus, radius);
  const double least = pair.radius_scale * Jkr::least_y * Jkr::least_y;  // where the grains part
  for (double a = 1.0001 * least; a < 40 * least; a *= 1.07) {
    CAPTURE(a / least);
    const double overlap = jkr_overlap_of(a), scale = pair.force_scale + std::abs(jkr_force_of(a));
    const Adhesive found = jkr_force(pair, overlap);
    CHECK(std::abs(found.force - jkr_force_of(a)) < 1e-11 * scale);
    CHECK(std::abs(found.contact_radius - a) < 1e-11 * a);
  }
}

TEST_CASE("JKR: the pull-off is 3/2 pi w R at held force and 5/6 pi w R at held gap", "[interaction]") {
  const Jkr pair = jkr(work, modulus, radius);
  const double unit = pi * work * radius;
  CHECK(pair.pull_off() == Approx(1.5 * unit).epsilon(1e-14));
  CHECK(pair.pull_off_at_held_gap() == Approx(5.0 / 6.0 * unit).epsilon(1e-14));
  CHECK(jkr_force(pair, -pair.reach()).force == Approx(-5.0 / 6.0 * unit).epsilon(1e-7));  // a root's precision there
  CHECK(jkr_force(pair, 0).force == Approx(-4.0 / 3.0 * unit).epsilon(1e-13));
  double least = 0;
  for (int k = 0; k <= 20000; ++k) least = std::min(least, jkr_force(pair, pair.reach() * (-1 + k / 10000.0)).force);
  CHECK(least == Approx(-1.5 * unit).epsilon(1e-8));
  // The reach is where the equations' overlap is least: da = 0.
  const double a = cube_root(pi * work * radius * radius / (8 * modulus));
  CHECK(pair.reach() == Approx(-jkr_overlap_of(a)).epsilon(1e-13));
  CHECK(jkr_pressing_force(pair, 0) == Approx(3 * unit).epsilon(1e-14));
}

TEST_CASE("JKR: grains meet at contact, part at the reach, and lose 7.09 (w^5 R^4/E^2)^(1/3)", "[interaction]") {
  const Jkr pair = jkr(work, modulus, radius);
  CHECK_FALSE(pair.touching(false, -1e-15));
  CHECK(pair.touching(false, 0));
  CHECK(pair.touching(true, -0.999 * pair.reach()));
  CHECK_FALSE(pair.touching(true, -1.001 * pair.reach()));
  const double lost = jkr_force(pair, -pair.reach()).energy - jkr_force(pair, 0).energy;
  const double published = std::cbrt(std::pow(work, 5) * std::pow(radius, 4) / (modulus * modulus));
  CHECK(lost / published == Approx(7.09).epsilon(1e-3));
}

TEST_CASE("JKR and DMT: the force is the slope of the energy, the stiffness that of the force", "[interaction]") {
  const Jkr pair = jkr(work, modulus, radius);
  for (const double overlap : {-0.9, -0.5, -0.01, 0.02, 0.7, 5.0, 60.0}) {
    CAPTURE(overlap);
    const double x = overlap * pair.reach(), h = 1e-4 * pair.reach();
    const Adhesive low = jkr_force(pair, x - h), high = jkr_force(pair, x + h), here = jkr_force(pair, x);
    CHECK((high.energy - low.energy) / (2 * h) == Approx(here.force).epsilon(1e-6));
    CHECK((high.force - low.force) / (2 * h) == Approx(here.stiffness).epsilon(1e-6));
  }
  for (const double range : {0.0, 4e-10}) {
    const Dmt hard = dmt(work, modulus, radius, range);
    for (const double x : {-3e-9, -1e-9, -1e-10, 1e-10, 3e-9}) {
      CAPTURE(range, x);
      const double h = 1e-4 * std::abs(x);
      const Adhesive low = dmt_force(hard, x - h), high = dmt_force(hard, x + h), here = dmt_force(hard, x);
      CHECK((high.energy - low.energy) / (2 * h) == Approx(here.force).epsilon(1e-6));
      CHECK((high.force - low.force) / (2 * h) == Approx(here.stiffness).epsilon(1e-6));
    }
  }
}

TEST_CASE("JKR far under load is Hertz's law with the work of adhesion lost in it", "[interaction]") {
  const Jkr pair = jkr(work, modulus, radius);
  const double overlap = 3e4 * pair.overlap_scale;
  const double hertz = 4.0 / 3.0 * modulus * std::sqrt(radius) * std::pow(overlap, 1.5);
  CHECK(jkr_force(pair, overlap).force == Approx(hertz).epsilon(1e-4));
}

TEST_CASE("DMT: Hertz less 2 pi w R; its reach is continuous at contact and at the end", "[interaction]") {
  const double pull = 2 * pi * work * radius, x = 2e-9;
  const Dmt bare = dmt(work, modulus, radius), reaching = dmt(work, modulus, radius, 4e-10);
  const double hertz = 4.0 / 3.0 * modulus * std::sqrt(radius * x) * x;
  CHECK(dmt_force(bare, x).force == Approx(hertz - pull).epsilon(1e-14));
  CHECK(dmt_force(bare, 0).force == Approx(-pull).epsilon(1e-14));
  CHECK(dmt_force(bare, -1e-12).force == 0);
  CHECK(bare.reach() == 0);
  CHECK(dmt_force(reaching, -1e-20).force == Approx(dmt_force(reaching, 0).force).epsilon(1e-8));
  CHECK(dmt_force(reaching, -1e-20).energy == Approx(dmt_force(reaching, 0).energy).epsilon(1e-8));
  CHECK(reaching.reach() == Approx(3.6e-9).epsilon(1e-14));
  CHECK(std::abs(dmt_force(reaching, -0.999999 * reaching.reach()).force) < 1e-7 * pull);
  CHECK(dmt_force(reaching, -1.000001 * reaching.reach()).force == 0);
  // Van der Waals' (z0/(z0 + gap))^2 less its hundredth: at gap = z0, 0.25 -> 0.24/0.99.
  CHECK(dmt_force(reaching, -4e-10).force == Approx(-pull * 0.24 / 0.99).epsilon(1e-12));
  CHECK(dmt_pressing_force(bare, -pull) == 0);
}

TEST_CASE("like grains stick by twice their surface energy; Tabor's number", "[interaction]") {
  CHECK(work_of_adhesion(0.07, 0.07) == Approx(0.14).epsilon(1e-14));
  CHECK(work_of_adhesion(0.02, 0.08) == Approx(0.08).epsilon(1e-14));
  CHECK(tabor_number(work, modulus, radius, 4e-10) ==
        Approx(std::cbrt(11e-6 * 0.14 * 0.14 / (3.7e9 * 3.7e9 * 6.4e-29))).epsilon(1e-13));
}
