// The laws whose stiffness grows faster with the force than Hertz's: rough surfaces and cones, against the formulas of
// their sources, written here by the library's powers.
#include <cmath>
#include <limits>

#include "rvelab/contact/model.hpp"
#include "tests/catch.hpp"

using namespace rvelab;

namespace {

const double pi = std::acos(-1.0);
constexpr double radius = 1e-3, modulus = 70e9, poisson = 0.2;

Material quartz(double roughness, double slope = 0.1) {
  Material m;
  m.young_modulus = modulus;
  m.poisson_ratio = poisson;
  m.roughness = roughness;
  m.cone_slope = slope;
  return m;
}

PairParameters pair_of(Law law, const Material& a, const Material& b, double ri = radius, double rj = radius) {
  ContactModel model;
  model.law = law;
  return mix(model, {}, a, ri, 1, b, rj, 1, 0);
}

/// A contact at one overlap.
struct Now {
  double root, force, stiffness, tangential, energy, growth;
};
template <class Force>
Now at(const PairParameters& q, double overlap) {
  const double root = Force::root(overlap, q.law_constant);
  return {root,
          Force::normal_force(q.kn, overlap, root, q.law_constant),
          Force::normal_stiffness(q.kn, root),
          Force::tangential_stiffness(q.kt, root),
          Force::normal_energy(q.kn, overlap, root, q.law_constant),
          Force::stiffness_growth(overlap, q.law_constant)};
}

/// Otsubo et al. 2017, as published: thresholds of the force, from them those of the overlap and the exponents.
struct Published {
  double s, plane_modulus, r, n1, n2, d1, d2, t1, t2, b, c;

  Published(double roughness, double plane, double reduced_radius)
      : s(roughness), plane_modulus(plane), r(reduced_radius) {
    n1 = s * plane_modulus * std::sqrt(2 * r * s);
    n2 = 100 * n1;
    d1 = 0.82 * s;
    d2 = 1.24 * s;
    t2 = d1 + d2 + std::pow(3 * n2 / (4 * plane_modulus * std::sqrt(r)), 2.0 / 3);
    b = 1.5 * (t2 - d1) / (t2 - d1 - d2);
    t1 = d1 + (t2 - d1) * std::pow(n1 / n2, 1 / b);
    c = b * t1 / (t1 - d1);
  }
  double force(double overlap) const {
    if (overlap < t1) return n1 * std::pow(overlap / t1, c);
    if (overlap < t2) return n2 * std::pow((overlap - d1) / (t2 - d1), b);
    return 4.0 / 3 * plane_modulus * std::sqrt(r) * std::pow(overlap - d1 - d2, 1.5);
  }
};

}  // namespace

TEST_CASE("rough surfaces have the three regimes of their source", "[contact][quick]") {
  for (const double roughness : {1e-7, 1e-6}) {
    const PairParameters q = pair_of(Law::hertz_rough, quartz(roughness), quartz(2 * roughness), radius, 2 * radius);
    const Published law(roughness * std::sqrt(5.0), modulus / (2 * (1 - poisson * poisson)), radius / 1.5);
    CHECK(q.law_constant == Approx(law.s).epsilon(1e-15));
    CHECK(law.c == Approx(2.59).epsilon(1e-3));
    for (double part = 1e-6; part < 1e4; part *= 1.37) {
      CAPTURE(roughness, part);
      CHECK(at<RoughForce>(q, part * law.s).force == Approx(law.force(part * law.s)).epsilon(2e-13));
    }
  }
}

TEST_CASE("force and stiffness of rough surfaces are continuous, begin at nothing and end as Hertz's",
          "[contact][quick]") {
  const PairParameters q = pair_of(Law::hertz_rough, quartz(1e-6), quartz(1e-6)),
                       hertz = pair_of(Law::hertz_mindlin, quartz(0), quartz(0));
  const Published law(q.law_constant, modulus / (2 * (1 - poisson * poisson)), radius / 2);
  for (const double threshold : {law.t1, law.t2}) {
    const Now below = at<RoughForce>(q, threshold * (1 - 1e-14)), above = at<RoughForce>(q, threshold * (1 + 1e-14));
    CHECK(above.force == Approx(below.force).epsilon(1e-12));
    CHECK(above.stiffness == Approx(below.stiffness).epsilon(1e-12));
    CHECK(above.tangential == Approx(below.tangential).epsilon(1e-12));
    CHECK(above.energy == Approx(below.energy).epsilon(1e-12));
  }
  // Softer than smooth spheres: without limit where they begin to touch, by the offset alone where they are pressed
  // far.
  const auto ratio = [&](double overlap) {
    return at<RoughForce>(q, overlap).stiffness / at<HertzMindlinForce>(hertz, overlap).stiffness;
  };
  CHECK(ratio(1e-3 * law.s) < 1e-3);
  CHECK(ratio(1e4 * law.s) > 1 - 2e-4);
  double last = 0;
  for (double part = 1e-4; part < 1e4; part *= 1.1) {
    CHECK(ratio(part * law.s) > last);
    last = ratio(part * law.s);
  }
  const double deep = 100 * law.s, behind = deep - law.d1 - law.d2;
  CHECK(at<RoughForce>(q, deep).force == Approx(at<HertzMindlinForce>(hertz, behind).force).epsilon(1e-14));
  CHECK(at<RoughForce>(q, deep).stiffness == Approx(at<HertzMindlinForce>(hertz, behind).stiffness).epsilon(1e-14));
  // Smooth ones are Hertz's to the last bit, open ones store nothing.
  const PairParameters smooth = pair_of(Law::hertz_rough, quartz(0), quartz(0));
  for (double overlap = 1e-12; overlap < 1e-3; overlap *= 3.7) {
    const Now a = at<RoughForce>(smooth, overlap), b = at<HertzMindlinForce>(hertz, overlap);
    CHECK(a.force == b.force);
    CHECK(a.stiffness == b.stiffness);
    CHECK(a.tangential == b.tangential);
  }
  for (const double s : {0.0, 1e-6})
    for (const double overlap : {0.0, -1e-6}) CHECK(RoughForce::root(std::max(0.0, overlap), s) == 0);
}

TEST_CASE("at one force, and at one energy, rough contacts are softer than smooth ones", "[contact][quick]") {
  // The step at a rate takes the frequency of Hertz's collision of the same energy, and its reach and 2.06 S.
  const PairParameters q = pair_of(Law::hertz_rough, quartz(1e-6), quartz(1e-6));
  for (double part = 1e-4; part < 1e3; part *= 1.2) {
    const double overlap = part * q.law_constant;
    const Now now = at<RoughForce>(q, overlap);
    const double by_force = std::pow(now.force / q.kn, 2.0 / 3), by_energy = std::pow(2.5 * now.energy / q.kn, 0.4);
    CHECK(now.stiffness <= 1.5 * q.kn * std::sqrt(by_force) * (1 + 1e-12));
    CHECK(now.stiffness <= 1.5 * q.kn * std::sqrt(by_energy) * (1 + 1e-12));
    CHECK(by_energy + 2.06 * q.law_constant >= overlap * (1 - 1e-12));
    const double speed = std::sqrt(2 * now.energy);
    CHECK(RoughImpact::reach(q.kn, 1, speed, q.law_constant) >= overlap * (1 - 1e-12));
    CHECK(RoughImpact::held_speed_squared(q.kn, overlap, q.law_constant) == Approx(speed * speed).epsilon(1e-12));
  }
}

TEST_CASE("cones: Sneddon's force of a cone of the slopes of both, whatever the radii", "[contact][quick]") {
  for (const double slope : {0.02, 0.3}) {
    const PairParameters q = pair_of(Law::cones, quartz(0, slope), quartz(0, 2 * slope), radius, 5 * radius);
    const double plane = modulus / (2 * (1 - poisson * poisson));
    for (const double overlap : {1e-9, 1e-7, 1e-5}) {
      const Now now = at<ConesForce>(q, overlap);
      // F = 2/pi E* d^2 tan(alpha), alpha the half apex angle (Sneddon 1965), dF/dd = 2 E* a, a = 2/pi d tan(alpha)
      const double half_apex = pi / 2 - std::atan(3 * slope);
      CHECK(now.force == Approx(2 / pi * plane * overlap * overlap * std::tan(half_apex)).epsilon(1e-12));
      CHECK(now.stiffness == Approx(4 / pi * plane * overlap * std::tan(half_apex)).epsilon(1e-12));
      CHECK(now.energy == Approx(now.force * overlap / 3).epsilon(1e-12));
    }
  }
}

TEST_CASE("Mindlin's ratio of stiffnesses, 2 (1 - nu)/(2 - nu), holds at any overlap", "[contact][quick]") {
  const auto expect = [](const Now& now) {
    CHECK(now.tangential / now.stiffness == Approx(2 * (1 - poisson) / (2 - poisson)).epsilon(1e-13));
  };
  const PairParameters rough = pair_of(Law::hertz_rough, quartz(5e-7), quartz(5e-7)),
                       cones = pair_of(Law::cones, quartz(0), quartz(0)),
                       hertz = pair_of(Law::hertz_mindlin, quartz(0), quartz(0));
  for (double overlap = 1e-10; overlap < 1e-3; overlap *= 2.3) {
    expect(at<RoughForce>(rough, overlap));
    expect(at<ConesForce>(cones, overlap));
    expect(at<HertzMindlinForce>(hertz, overlap));
  }
}

TEST_CASE("the energy is the integral of the force, the growth that of the stiffness", "[contact][quick]") {
  const auto check = [](auto force, const PairParameters& q) {
    using Force = decltype(force);
    double sum = 0, from = 0;
    for (double to = 1e-9; to < 2e-4; from = to, to *= 1.02) {
      // Three points of Gauss: exact to the fifth degree, 1e-9 of a power over 2 %.
      const double middle = 0.5 * (from + to), half = 0.5 * (to - from), off = half * std::sqrt(0.6);
      sum += half / 9 *
             (5 * at<Force>(q, middle - off).force + 8 * at<Force>(q, middle).force +
              5 * at<Force>(q, middle + off).force);
      const Now now = at<Force>(q, to), low = at<Force>(q, to * (1 - 1e-4)), high = at<Force>(q, to * (1 + 1e-4));
      CAPTURE(to);
      if (to > 1e-8) CHECK(now.energy == Approx(sum).epsilon(2e-5));
      // Of a threshold one side or the other.
      CHECK(std::log(high.tangential / low.tangential) / (2e-4 * to) <= std::max(low.growth, high.growth) * 1.001);
      CHECK(std::log(high.tangential / low.tangential) / (2e-4 * to) >= std::min(low.growth, high.growth) * 0.999);
    }
  };
  check(RoughForce{}, pair_of(Law::hertz_rough, quartz(5e-7), quartz(1e-6)));
  check(ConesForce{}, pair_of(Law::cones, quartz(0), quartz(0)));
  check(HertzMindlinForce{}, pair_of(Law::hertz_mindlin, quartz(0), quartz(0)));
}

TEST_CASE("roots of cone collisions are those of the standard library", "[contact][quick]") {
  for (double measure = 1e-20; measure < 1e30; measure *= 17) {
    CHECK(ConeImpact::frequency(measure) == Approx(std::sqrt(2 * std::cbrt(1.5 * measure))).epsilon(1e-13));
    CHECK(ConeImpact::reach(measure, 2, 3, 0) == Approx(std::cbrt(27 / measure)).epsilon(1e-13));
  }
  CHECK(ConeImpact::frequency(0) == 0);
  CHECK(ConeImpact::reach(1e9, 1, 0, 0) == 0);
}

TEST_CASE("roughness and slopes out of range are refused by name", "[contact][quick]") {
  ContactModel model;
  model.law = Law::hertz_rough;
  CHECK_NOTHROW(check_parameters(model, {}, {quartz(1e-7)}));
  CHECK_THROWS_WITH(check_parameters(model, {}, {quartz(0)}),
                    Catch::Contains("roughness = 0") && Catch::Contains("contact.law = hertz_mindlin"));
  model.law = Law::cones;
  CHECK_THROWS_WITH(check_parameters(model, {}, {quartz(0, 0)}), Catch::Contains("cone_slope = 0"));
  // LAMMPS' dashpots are written for Hertz's spheres.
  Damping damping;
  for (const Dashpot dashpot : {Dashpot::viscoelastic, Dashpot::tsuji}) {
    damping.dashpot = dashpot;
    CHECK_THROWS_WITH(check_parameters(model, damping, {quartz(0)}),
                      Catch::Contains("does not go with contact.law = cones; allowed: hertz_mindlin, hertz_stiffness"));
  }
}
