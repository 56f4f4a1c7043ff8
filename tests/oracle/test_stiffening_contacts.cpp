// Two grains with rough surfaces or cones: collisions of any speed, and paths that press, slip and unload.
#include <cmath>

#include "tests/oracle/two_grains.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

constexpr double roughness = 1e-5, combined = 1.4142135623730951 * roughness;

Material material(double friction = 0) {
  Material m;
  m.young_modulus = 7e7;
  m.poisson_ratio = 0.25;
  m.roughness = roughness;
  m.cone_slope = 0.05;
  m.friction = friction;
  return m;
}

PairParameters pair_of(const Specimen& s) {
  return mix(s.contact, s.damping, s.materials[0], 0.1, mass_of(s), s.materials[0], 0.1, mass_of(s), 0);
}

double energy_at(const Specimen& s, double overlap) {
  const PairParameters q = pair_of(s);
  return with_law(s.contact.law, [&](auto law) {
    using Force = typename decltype(law)::Force;
    return Force::normal_energy(q.kn, overlap, Force::root(overlap, q.law_constant), q.law_constant);
  });
}

/// Speed of an approach that ends at this overlap, m/s.
double speed_to(const Specimen& s, double overlap) { return std::sqrt(2 * energy_at(s, overlap) / (0.5 * mass_of(s))); }

/// 2 int_0^d dx/sqrt(v^2 - 2 U/m*), with x = d (1 - z^2) so that nothing is infinite at the end.
double duration_to(const Specimen& s, double deepest) {
  const double mass = 0.5 * mass_of(s), squared = std::pow(speed_to(s, deepest), 2);
  constexpr int parts = 20'000;
  double sum = 0;
  for (int k = 0; k < parts; ++k) {
    const double z = (k + 0.5) / parts, x = deepest * (1 - z * z);
    sum += 2 * z * deepest / std::sqrt(squared - 2 * energy_at(s, x) / mass) / parts;
  }
  return 2 * sum;
}

}  // namespace

TEST_CASE("a contact of cones lasts 2.804 delta_max over the speed and returns all of it") {
  // m* delta'' = -k delta^2: delta_max^3 = 3 m* v^2/(2 k), T = 2 delta_max/v int_0^1 dx/sqrt(1 - x^3)
  const double integral = std::sqrt(pi) * std::tgamma(1.0 / 3) / (3 * std::tgamma(5.0 / 6));
  CHECK(2 * integral == Approx(2.804364).epsilon(1e-6));
  const double speed = GENERATE(0.05, 1.0);
  const Specimen s = two_grains(Shape::sphere, material(), Law::cones, 1);
  const double k = 2 * 0.5 * 7e7 / (1 - 0.25 * 0.25) / (pi * 0.1);
  const double deepest = std::cbrt(1.5 * 0.5 * mass_of(s) * speed * speed / k);
  CHECK(speed_to(s, deepest) == Approx(speed));
  const Collision found = collide(s, speed, 2 * integral * deepest / speed, 4000);
  CHECK(found.duration == Approx(2 * integral * deepest / speed).epsilon(2e-6));
  CHECK(found.restitution == Approx(1).epsilon(1e-6));
}

TEST_CASE("rough grains return all of the speed, in each of the three regimes") {
  const double part = GENERATE(0.5, 10.0, 200.0);
  const Specimen s = two_grains(Shape::sphere, material(), Law::hertz_rough, 1);
  const double speed = speed_to(s, part * combined), expected = duration_to(s, part * combined);
  const Collision found = collide(s, speed, expected, 4000);
  CHECK(found.duration == Approx(expected).epsilon(2e-5));
  CHECK(found.restitution == Approx(1).epsilon(1e-6));
}

TEST_CASE("a dashpot of cones and of rough grains gives back one restitution, at any speed") {
  const Law law = GENERATE(Law::hertz_rough, Law::cones);
  const double e = GENERATE(0.8, 0.3), part = GENERATE(0.5, 10.0, 200.0);
  Specimen s = two_grains(Shape::sphere, material(), law, 1);
  s.damping.dashpot = Dashpot::restitution;
  s.damping.restitution = e;
  CAPTURE(name(law), e, part);
  const double speed = speed_to(s, part * combined);
  CHECK(collide(s, speed, duration_to(s, part * combined), 16000).restitution == Approx(e).epsilon(5e-4));
  // The force never pulls: other damping, the same restitution.
  s.damping.no_tension = true;
  CHECK(collide(s, speed, duration_to(s, part * combined), 16000).restitution == Approx(e).epsilon(5e-4));
}

TEST_CASE("steps that follow the contacts resolve collisions of cones and of rough grains") {
  const Law law = GENERATE(Law::hertz_rough, Law::cones);
  const double e = GENERATE(1.0, 0.5), part = GENERATE(0.01, 0.5, 10.0, 200.0);
  Specimen s = two_grains(Shape::sphere, material(), law, 0.5 * combined);
  s.solver.energy_balance = true;
  s.damping.dashpot = e < 1 ? Dashpot::restitution : Dashpot::none;
  s.damping.restitution = e;
  CAPTURE(name(law), e, part);
  const double speed = speed_to(s, part * combined);
  Rve rve(s);
  rve.set_velocities({Vector3(0.5 * speed, 0, 0), Vector3(-0.5 * speed, 0, 0)}, {Vector3::Zero(), Vector3::Zero()});
  const Report report = rve.apply(Matrix3::Zero(), 4 * duration_to(s, part * combined) + 4 * combined / speed).report;
  const Specimen after = rve.specimen();
  REQUIRE(gap_of(rve) > 0);
  const double left = (after.grains.velocity[1] - after.grains.velocity[0]).x() / speed;
  CHECK(left == Approx(e).epsilon(0.02));
  if (part > 0.1) CHECK(report.substeps < 3000);  // slower, the critical step of pressed contacts decides
}

TEST_CASE("an unloading normal force takes the tangential one along with its stiffness, a reloading one leaves it") {
  const Law law = GENERATE(Law::hertz_rough, Law::cones);
  const Shape shape = GENERATE(Shape::disc, Shape::sphere);
  for (const double part : {1.0, 12.0, 100.0}) {
    Driven pair(shape, material(1e6), law, part * combined);
    const double turn = 1e-7;
    const ContactState slipped = pair.drive(0, turn, turn);
    const double start = slipped.tangential_force.norm();
    CHECK(start == Approx(slipped.tangential_stiffness * turn * (0.2 - slipped.overlap)).epsilon(1e-6));
    const ContactState opened = pair.drive(-0.4 * part * combined, 0, 0);
    CHECK(opened.tangential_force.norm() / start ==
          Approx(opened.tangential_stiffness / slipped.tangential_stiffness).epsilon(1e-9));
    const ContactState closed = pair.drive(0.4 * part * combined, 0, 0);
    CHECK(closed.tangential_force.norm() == Approx(opened.tangential_force.norm()).epsilon(1e-9));
    const ContactState nudged = pair.drive(-1e-5 * part * combined, 0, 0);
    CHECK(std::log(closed.tangential_stiffness / nudged.tangential_stiffness) / (closed.overlap - nudged.overlap) ==
          Approx(closed.stiffness_growth).epsilon(1e-3));  // what the tangent of the network takes
    // The spring holds what it held: unloading takes no energy out of it that the law does not book.
    CHECK(slipped.elastic_energy - energy_at(two_grains(shape, material(), law, 1), slipped.overlap) ==
          Approx(0.5 * start * start / slipped.tangential_stiffness).epsilon(1e-3));
  }
}
