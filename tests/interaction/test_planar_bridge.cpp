// Bridges between discs against limits in closed form, an area summed strip by strip, and thermodynamics.
#include <cmath>

#include "rvelab/interaction/planar_bridge.hpp"
#include "tests/catch.hpp"
#include "tests/specimens.hpp"

using namespace rvelab::interaction;
using rvelab::test::pi;

namespace {

/// Area between the discs below both menisci, by strips along the line of centres; twice the upper half.
double area_by_strips(const PlanarPair& p, double gap, double rho, double height, double x1) {
  const double L = p.r1 + p.r2 + gap;
  const auto angle = [&](double x, double r) {
    return std::atan2(height, x) - std::atan2(rho * std::sin(p.theta), r + rho * std::cos(p.theta));
  };
  const double left = p.r1 * std::cos(angle(x1, p.r1)), right = L - p.r2 * std::cos(angle(L - x1, p.r2));
  double sum = 0;
  const int n = 200000;
  const double low = std::min(left, p.r1), high = std::max(right, L - p.r2), dx = (high - low) / n;
  for (int k = 0; k < n; ++k) {
    const double x = low + (k + 0.5) * dx;
    const double below1 = x < p.r1 ? std::sqrt(p.r1 * p.r1 - x * x) : 0;
    const double below2 = L - x < p.r2 ? std::sqrt(p.r2 * p.r2 - (L - x) * (L - x)) : 0;
    if (x < left || x > right) continue;
    const double top = height - std::sqrt(rho * rho - (x - x1) * (x - x1));
    sum += std::max(0.0, top - std::max(below1, below2)) * dx;
  }
  return 2 * sum;
}

}  // namespace

TEST_CASE("planar bridges: the volume of arcs is the area between them", "[interaction]") {
  for (const PlanarPair p : {PlanarPair{1, 1, 0, 1}, PlanarPair{1, 2.5, 0, 1}, PlanarPair{1, 1.7, 0.5, 1}})
    for (const double gap : {0.0, 0.05}) {
      CAPTURE(p.r2, p.theta, gap);
      const double rho = 0.2, c = std::cos(p.theta), L = p.r1 + p.r2 + gap;
      const double D1 = p.r1 * p.r1 + rho * rho + 2 * p.r1 * rho * c, D2 = p.r2 * p.r2 + rho * rho + 2 * p.r2 * rho * c;
      const double x1 = (L * L + D1 - D2) / (2 * L), height = std::sqrt(D1 - x1 * x1);
      CHECK(planar_suction_bridge(p, p.tension / rho, gap).volume ==
            Approx(area_by_strips(p, gap, rho, height, x1)).epsilon(1e-6));
    }
}

TEST_CASE("planar bridges: two equal discs in contact, and at rupture, in numbers worked by hand", "[interaction]") {
  // R = 3, rho = 2, theta = 0: the centre of the arc is 5 from the discs' centres, 4 above their line at a gap of 0:
  // pull 2 * 4/2; V = 6 * 4 - 2 * 9 atan(4/3) - 4 (pi - 2 atan(4/3)).
  const PlanarPair p{3, 3, 0, 1};
  const double angle = std::atan2(4.0, 3.0), volume = 24 - 18 * angle - 4 * (pi - 2 * angle);
  const BridgeState contact = planar_suction_bridge(p, 0.5, 0);
  CHECK(contact.force == Approx(-4).epsilon(1e-14));
  CHECK(contact.volume == Approx(volume).epsilon(1e-13));
  CHECK(contact.suction == Approx(0.5).epsilon(1e-14));
  // Menisci touch where the arc's centre is 2 above: half the distance sqrt(25 - 4).
  const double rupture = 2 * std::sqrt(21) - 6;
  CHECK(planar_rupture_gap_of_suction(p, 0.5) == Approx(rupture).epsilon(1e-14));
  CHECK(planar_suction_bridge(p, 0.5, rupture * (1 - 1e-13)).force == Approx(-2).epsilon(1e-10));
  CHECK(planar_suction_bridge(p, 0.5, rupture * (1 + 1e-12)).force == 0);
}

TEST_CASE("planar bridges: a small one is a meniscus between parallel plates", "[interaction]") {
  // h = 2 rho cos(theta). Touching arcs leave h times 2 rho less two segments, and less the part of the arcs' chords.
  for (const double theta : {0.0, 0.6}) {
    const PlanarPair p{1, 1, theta, 1};
    const double rho = 1e-5, c = std::cos(theta), s = std::sin(theta),
                 rupture = planar_rupture_gap_of_suction(p, 1 / rho);
    CHECK(rupture == Approx(2 * rho * c).epsilon(1e-4));
    const double plates = 2 * (2 * rho * c * rho - rho * rho * s * c - rho * rho * (pi / 2 - theta));
    CHECK(planar_suction_bridge(p, 1 / rho, rupture * (1 - 1e-9)).volume == Approx(plates).epsilon(2e-3));
  }
}

TEST_CASE("planar bridges: force, stiffness, energy, Maxwell's relation", "[interaction]") {
  for (const PlanarPair p :
       {PlanarPair{1, 1, 0, 0.073}, PlanarPair{1, 3, 0.4, 0.073}, PlanarPair{2, 0.8, 0.7, 0.073}}) {
    const double suction = 0.073 / 0.15, open = planar_rupture_gap_of_suction(p, suction);
    const auto held = [&](double gap) { return planar_suction_bridge(p, suction, gap); };
    for (const double part : {0.02, 0.3, 0.7, 0.97}) {
      CAPTURE(p.r2, p.theta, part);
      const double h = 1e-5 * open, gap = part * open;
      CHECK(-(held(gap + h).energy - held(gap - h).energy) / (2 * h) == Approx(held(gap).force).epsilon(1e-7));
      CHECK(-(held(gap + h).force - held(gap - h).force) / (2 * h) == Approx(held(gap).stiffness).epsilon(1e-6));
      const double dS = 1e-5 * suction;
      const double pull_over_suction =
          -(planar_suction_bridge(p, suction + dS, gap).force - planar_suction_bridge(p, suction - dS, gap).force) /
          (2 * dS);
      CHECK(pull_over_suction == Approx((held(gap + h).volume - held(gap - h).volume) / (2 * h)).epsilon(1e-6));
    }
    CHECK(held(open * (1 - 1e-12)).force == Approx(-2 * p.tension).epsilon(1e-5));
    CHECK(held(open * (1 + 1e-9)).force == 0);
    CHECK(std::abs(held(open * (1 - 1e-12)).energy) < 1e-10);
    // Overlapping discs.
    const BridgeState contact = held(0), over = held(-0.01);
    CHECK(over.force == contact.force);
    CHECK(over.stiffness == 0);
    CHECK(over.energy == Approx(contact.energy + 0.01 * contact.force).epsilon(1e-12));
  }
}

TEST_CASE("planar bridges: radii change places", "[interaction]") {
  const PlanarPair p{1, 2.5, 0.3, 1}, q{2.5, 1, 0.3, 1};
  CHECK(planar_suction_bridge(p, 4, 0.02).force == Approx(planar_suction_bridge(q, 4, 0.02).force).epsilon(1e-13));
  CHECK(planar_suction_bridge(p, 4, 0.02).volume == Approx(planar_suction_bridge(q, 4, 0.02).volume).epsilon(1e-12));
}
