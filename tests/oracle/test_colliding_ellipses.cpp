// Two ellipses that collide: momentum, angular momentum and energy, with Hertz's radius from curvature too.
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Two ellipses of aspect 0.5 and 0.7 that fly at each other off their axes, turning.
Specimen colliding(double kt = 0, Law law = Law::linear_stiffness, double friction = 1e6) {
  Material m = linear_material(1e6, kt, friction);
  m.young_modulus = 5e7;
  m.poisson_ratio = 0.2;
  Specimen s = empty_specimen(Shape::ellipse, 3, m, law);
  add_ellipse(s, {-0.2, -0.05, 0}, 0.2, 0.1, 0.4);
  add_ellipse(s, {0.15, 0.05, 0}, 0.15, 0.105, 1.9);
  // At rest in the mean: a mean velocity would be taken out.
  const double ratio = (0.2 * 0.1) / (0.15 * 0.105);
  s.grains.velocity = {Vector3(0.5, 0.1, 0), Vector3(-0.5, -0.1, 0) * ratio};
  s.grains.spin = {Vector3(0, 0, 1), Vector3(0, 0, -2)};
  s.state.last_step.loading = Loading::at_rate;
  s.state.list.built = false;
  return s;
}

struct Conserved {
  Vector3 momentum = Vector3::Zero();
  double about_origin = 0, kinetic = 0;
};

Conserved conserved(const Rve& rve) {
  Conserved all;
  for (const GrainState& g : rve.network().grains) {
    all.momentum += g.mass * g.velocity;
    all.about_origin += g.mass * g.position.cross(g.velocity)[2] + g.inertia * g.spin[2];
    all.kinetic += 0.5 * (g.mass * g.velocity.squaredNorm() + g.inertia * g.spin.squaredNorm());
  }
  return all;
}

/// Flies until the two have parted, at steps of `step` (s); the relative change of the kinetic energy.
double energy_gained(Specimen s, double step) {
  s.solver.fixed_time_step = step * (1 + 1e-9);
  Rve rve(s);
  rve.set_velocities(s.grains.velocity, s.grains.spin);
  const Conserved before = conserved(rve);
  const double scale = rve.network().grains[0].mass * s.grains.velocity[0].norm();
  bool touched = false;
  for (int k = 0; k < 60; ++k) {
    rve.apply(Matrix3::Zero(), 8e-3);
    touched = touched || !rve.network().contacts.empty();
    const Conserved now = conserved(rve);
    CHECK(now.momentum.norm() < 1e-13 * scale);
    // x from v of half a step before: x cross v does not see it, for x moves along v.
    CHECK(now.about_origin == Approx(before.about_origin).epsilon(1e-10));
  }
  REQUIRE(touched);
  REQUIRE(rve.network().contacts.empty());
  return conserved(rve).kinetic / before.kinetic - 1;
}

/// The collision of two Hertz ellipses at steps of `step` (s), over the kinetic energy before: the gain in energy, what
/// the change of R* puts into 2/5 f delta on the way, int (f delta/5)(dR*/R*), and what springs lose as kt falls, and
/// at the last where a contact opens.
struct Gain {
  double energy = 0, by_radius = 0, lost = 0;
};
Gain gain_by_radius(Specimen s, double step) {
  s.solver.fixed_time_step = step * (1 + 1e-9);
  s.solver.energy_balance = true;
  Rve rve(s);
  rve.set_velocities(s.grains.velocity, s.grains.spin);
  const double before = conserved(rve).kinetic;
  Gain gain;
  double last_work = 0, last_radius = 0;  // f delta and ln of what R* goes with
  bool touched = false;
  for (int k = 0; k < 6000 && !(touched && last_work == 0); ++k) {
    rve.apply(Matrix3::Zero(), 8e-5);
    const Network net = rve.network();
    double work = 0, radius = 0;
    for (const ContactState& c : net.contacts) {
      work = c.normal_force * c.overlap;
      radius = std::log(c.normal_force * c.normal_force / (c.overlap * c.overlap * c.overlap));
      const double spring = 0.5 * c.tangential_force.squaredNorm() / c.tangential_stiffness;
      CHECK(c.elastic_energy == Approx(0.4 * work + spring).epsilon(1e-12));
    }
    if (work > 0 && last_work > 0) gain.by_radius += 0.1 * (work + last_work) * (radius - last_radius);
    touched = touched || work > 0;
    last_work = work;
    last_radius = radius;
  }
  REQUIRE(touched);
  REQUIRE(last_work == 0);
  const EnergyTerms ledger = rve.specimen().state.energy_balance;
  return {conserved(rve).kinetic / before - 1, gain.by_radius / before, (ledger.law_loss + ledger.friction) / before};
}

}  // namespace

TEST_CASE("Two ellipses that collide keep momentum, angular momentum and energy") {
  const double coarse = energy_gained(colliding(), 4e-5), fine = energy_gained(colliding(), 1e-5);
  INFO(coarse << " at 4e-5 s, " << fine << " at 1e-5 s");
  // Leapfrog: errors of (omega dt)^2, omega = 900 1/s here.
  CHECK(std::abs(coarse) < 2e-3);
  CHECK(std::abs(fine) < std::max(0.15 * std::abs(coarse), 1e-7));
}

TEST_CASE(
    "Hertz ellipses that collide keep energy with the equivalent radius; with that of the curvature its change "
    "makes the difference") {
  const Specimen equivalent = colliding(0, Law::hertz_mindlin, 0);
  Specimen curvature = equivalent;
  curvature.contact.hertz_radius = HertzRadius::curvature;
  CHECK(std::abs(energy_gained(equivalent, 4e-5)) < 1e-4);
  CHECK(std::abs(energy_gained(equivalent, 1e-5)) < 1e-5);
  energy_gained(curvature, 4e-5);  // momentum and angular momentum
  const Gain none = gain_by_radius(equivalent, 1e-5), gain = gain_by_radius(curvature, 1e-5);
  INFO(none.energy << ", " << none.by_radius << "; " << gain.energy << ", " << gain.by_radius);
  CHECK(none.lost == 0);
  CHECK(gain.lost == 0);
  CHECK(std::abs(none.by_radius) < 1e-12);
  CHECK(std::abs(gain.energy) > 1e-3);
  CHECK(gain.energy == Approx(gain.by_radius).epsilon(1e-4));
}

TEST_CASE("Of Hertz ellipses that stick, law loss and the change of their radius of curvature account for the energy") {
  for (const HertzRadius radius : {HertzRadius::equivalent, HertzRadius::curvature}) {
    Specimen s = colliding(0, Law::hertz_mindlin);
    s.contact.hertz_radius = radius;
    const Gain gain = gain_by_radius(s, 2e-6);
    CAPTURE(name(radius), gain.energy, gain.by_radius, gain.lost);
    CHECK(gain.lost > 1e-3);
    CHECK((std::abs(gain.by_radius) > 1e-3) == (radius == HertzRadius::curvature));
    CHECK(std::abs(gain.energy + gain.lost - gain.by_radius) < 1e-5);
  }
}

TEST_CASE("Ellipses that stick to each other keep angular momentum too") {
  Specimen s = GENERATE(colliding(8e5), colliding(0, Law::hertz_mindlin));
  s.contact.hertz_radius = s.contact.law == Law::hertz_mindlin ? HertzRadius::curvature : HertzRadius::equivalent;
  s.solver.fixed_time_step = 1e-5;
  Rve rve(s);
  rve.set_velocities(s.grains.velocity, s.grains.spin);
  const Conserved before = conserved(rve);
  double largest_torque = 0;
  for (int k = 0; k < 60; ++k) {
    rve.apply(Matrix3::Zero(), 8e-3);
    const Conserved now = conserved(rve);
    CHECK(now.about_origin == Approx(before.about_origin).epsilon(1e-10));
    const Network net = rve.network();
    for (const GrainState& g : net.grains) largest_torque = std::max(largest_torque, g.torque.norm());
    for (const ContactState& c : net.contacts) CHECK((c.arm_i - c.arm_j - c.branch).norm() < 1e-15);
  }
  CHECK(largest_torque > 1);
}
