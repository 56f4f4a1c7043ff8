// Collisions of rocks: constants, records, books of energy and momentum.
#include "rvelab/contact/hertz_mindlin.hpp"
#include "tests/catch.hpp"
#include "tests/mpm/rocks.hpp"
#include "tests/oracle/reference_collision.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

const auto in_the_open = [](double) { return std::vector<Wall<3>>{}; };

/// Of the grains of rvelab.
struct Grain : rvelab::YoungModulus, rvelab::PoissonRatio {};

Grain grain_of(const RockMaterial& material) {
  Grain grain;
  grain.young_modulus = material.young_modulus;
  grain.poisson_ratio = material.poisson_ratio;
  return grain;
}

/// Factor of the dashpot, cn/sqrt(m* k delta^(1/2)), of LAMMPS' `damping tsuji` (Tsuji et al. 1992).
double tsuji(double e) {
  return 1.2728 + e * (-4.2783 + e * (11.087 + e * (-22.348 + e * (27.467 + e * (-18.022 + e * 4.8218)))));
}

/// The restitution of which sqrt(5) zeta is that factor: ln^2 e (5/factor^2 - 1) = pi^2.
double restitution_of(double factor) { return std::exp(-pi / std::sqrt(5 / (factor * factor) - 1)); }

/// Two spheres by the formulas of LAMMPS' record (pair_style granular, hertz/material, mindlin_rescale/force, damping
/// tsuji; velocity Verlet). The slip is taken at arms r - share overlap: LAMMPS takes share = 0, rocks the place where
/// the force acts, share = 1/2.
struct TwoSpheres {
  struct Sphere {
    double r, mass;
    Vec<3> x, v, w, force = Vec<3>::Zero(), torque = Vec<3>::Zero();
  } ball[2];
  double modulus, ratio, friction, dashpot, share;
  Vec<3> spring = Vec<3>::Zero();
  double last = 0;  // sqrt(r* overlap)

  void kick(double dt) {
    for (auto& each : ball) {
      each.v += 0.5 * dt / each.mass * each.force;
      each.w += 0.5 * dt / (0.4 * each.mass * each.r * each.r) * each.torque;
    }
  }
  void step(double dt) {
    kick(dt);
    for (auto& each : ball) each.x += dt * each.v;
    find_forces(dt);
    kick(dt);
  }
  void find_forces(double dt) {
    auto& [i, j] = ball;
    for (auto& each : ball) each.force = each.torque = Vec<3>::Zero();
    const Vec<3> n = (i.x - j.x).normalized();
    const double overlap = i.r + j.r - (i.x - j.x).norm();
    if (!(overlap > 0)) {
      spring.setZero();
      last = 0;
      return;
    }
    const double r = i.r * j.r / (i.r + j.r), m = i.mass * j.mass / (i.mass + j.mass), a = std::sqrt(r * overlap);
    const double kn = 4.0 / 3 * modulus / (2 * (1 - ratio * ratio)) * a;
    const double kt = 8 * modulus / (4 * (2 - ratio) * (1 + ratio)) * a, c = dashpot * std::sqrt(m * kn);
    const Vec<3> v = i.v - j.v, turning = (i.r - share * overlap) * i.w + (j.r - share * overlap) * j.w;
    const double vn = v.dot(n), fn = kn * overlap - c * vn;
    const Vec<3> vt = v - vn * n + n.cross(turning);
    if (a < last) spring *= a / last;
    last = a;
    const double length = spring.norm();
    spring -= spring.dot(n) * n;
    if (spring.norm() > 0) spring *= length / spring.norm();
    spring -= kt * dt * vt;
    Vec<3> ft = spring - c * vt;
    if (ft.norm() > friction * std::abs(fn)) {
      ft *= friction * std::abs(fn) / ft.norm();
      spring = ft + c * vt;
    }
    i.force = fn * n + ft;
    j.force = -i.force;
    for (auto& each : ball) each.torque = -(each.r - 0.5 * overlap) * n.cross(ft);
  }
};

struct Compared {
  double velocity = 0, spin = 0;                          // of the formulas from the record, m/s and rad/s
  double rock_velocity = 0, rock_spin = 0;                // of rocks from the formulas with slip at the contact
  double from_record_velocity = 0, from_record_spin = 0;  // of rocks from the record
  double largest_velocity = 0, largest_spin = 0;          // of the record
};

Compared compare_with_record(const std::string& name) {
  using rvelab::test::vector_from;
  const auto parameters = rvelab::test::recorded_json("lammps/micro/params.json").at(name);
  const rvelab::test::RecordedTable record("lammps/micro/" + name + ".csv");
  const auto& model = parameters.at("model");
  const double factor = tsuji(model.at("eta_n"));
  Rocks<3> rocks;
  rocks.materials = {{model.at("E"), model.at("nu"), model.at("mu"), restitution_of(factor)}};
  rocks.steps_per_collision = 1e-9;  // one sub-step a step
  TwoSpheres formulas{{}, model.at("E"), model.at("nu"), model.at("mu"), factor, 0};
  for (std::size_t g = 0; g < 2; ++g) {
    const auto& ball = parameters.at("spheres").at(g);
    auto& body = add_rock<3>(rocks, RockShape<3>::sphere(ball.at("r")), ball.at("rho"), vector_from(ball.at("x")),
                             vector_from(ball.at("v")))
                     .body;
    body.set_spin(vector_from(ball.at("w")));
    formulas.ball[g] = {ball.at("r"), body.mass, body.centre, body.velocity, vector_from(ball.at("w"))};
  }
  auto at_contact = formulas;
  at_contact.share = 0.5;
  Compared found;
  const auto grow = [](double& most, const Vec<3>& difference) { most = std::max(most, difference.norm()); };
  long step = 0;
  for (std::size_t row = 0; row < record.rows(); ++row) {
    for (const double dt = parameters.at("dt"); step < long(record.at(row, "step")); ++step) {
      rocks.advance(in_the_open, Vec<3>::Zero(), 0, dt);
      formulas.step(dt);
      at_contact.step(dt);
    }
    for (std::size_t g = 0; g < 2; ++g) {
      const auto id = std::to_string(g + 1);
      const auto& body = rocks.all[g].body;
      const Vec<3> v = record.vector(row, "v", id), w = record.vector(row, "w", id);
      grow(found.velocity, formulas.ball[g].v - v);
      grow(found.spin, formulas.ball[g].w - w);
      grow(found.rock_velocity, body.velocity - at_contact.ball[g].v);
      grow(found.rock_spin, body.spin() - at_contact.ball[g].w);
      grow(found.from_record_velocity, body.velocity - v);
      grow(found.from_record_spin, body.spin() - w);
      grow(found.largest_velocity, v);
      grow(found.largest_spin, w);
    }
  }
  return found;
}

/// A sphere and superquadrics that fly at each other, turned and spinning.
Rocks<3> flying_rocks(int count, double friction, double restitution) {
  Rocks<3> rocks;
  rocks.materials = {{5e7, 0.2, friction, restitution}};
  const Vec<3> centres[] = {Vec<3>(0, 0, 0), Vec<3>(0.25, 0.02, -0.03), Vec<3>(0.1, 0.26, 0.02)};
  const Vec<3> velocities[] = {Vec<3>(0.4, 0.3, 0.02), Vec<3>(-1, 0.1, 0), Vec<3>(0, -1.2, 0.1)};
  const Vec<3> spins[] = {Vec<3>(1, 2, -3), Vec<3>(-2, 4, 1), Vec<3>(3, 0.5, -1)};
  const RockShape<3> shapes[] = {RockShape<3>::superquadric(Vec<3>(0.12, 0.09, 0.08), 4, 3),
                                 RockShape<3>::superquadric(Vec<3>(0.1, 0.08, 0.07), 6, 6),
                                 RockShape<3>::superquadric(Vec<3>(0.08, 0.11, 0.09), 2, 2)};
  for (int k = 0; k < count; ++k) {
    auto& rock = add_rock<3>(rocks, shapes[k], 2600, centres[k], velocities[k]);
    rock.body.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.4 + k, Vec<3>(1, 2 - k, 1).normalized()));
    rock.body.set_spin(spins[k]);
  }
  rocks.first_energy = rocks.energy(Vec<3>::Zero()).residual;
  return rocks;
}

Vec<3> angular_momentum_of(const Rocks<3>& rocks) {
  Vec<3> sum = Vec<3>::Zero();
  for (const auto& rock : rocks.all)
    sum += rock.body.angular_momentum + rock.body.mass * rock.body.centre.cross(rock.body.velocity);
  return sum;
}

/// J, largest error of the books of an oblique collision of two spheres, with a number of sub-steps a collision.
struct Books {
  double worst = 0, lost = 0, kinetic = 0;  // J; kinetic: at the start
};
Books books_of(double friction, double restitution, double finer) {
  Rocks<3> rocks;
  rocks.materials = {{1e8, 0.25, friction, restitution}};
  add_rock<3>(rocks, RockShape<3>::sphere(0.1), 2650, Vec<3>(-0.155, 0, 0), Vec<3>(1, 0, 0));
  add_rock<3>(rocks, RockShape<3>::sphere(0.06), 2650, Vec<3>(0, 0.04, 0.01));
  rocks.all[0].body.set_spin(Vec<3>(1, 2, -3));
  rocks.steps_per_collision = 1e-9;  // one sub-step a step
  rocks.first_energy = rocks.energy(Vec<3>::Zero()).residual;
  Books books;
  books.kinetic = rocks.all[0].body.kinetic();
  bool touched = false;
  for (long step = 0; step < long(2500 * finer); ++step) {
    rocks.advance(in_the_open, Vec<3>::Zero(), 0, 2e-5 / finer);
    touched = touched || rocks.touching > 0;
    books.worst = std::max(books.worst, std::abs(rocks.energy(Vec<3>::Zero()).residual));
  }
  REQUIRE(touched);
  CHECK(rocks.touching == 0);
  books.lost = rocks.contact_loss;
  return books;
}

}  // namespace

TEST_CASE("two materials mix as grains of the Hertz-Mindlin law do") {
  const RockMaterial basalt{50e9, 0.2, 0.3, 1}, wood{8e9, 0.35, 0.5, 1}, rubber{1e6, 0.49, 0.8, 1};
  for (const auto* other : {&basalt, &wood, &rubber}) {
    for (const double radius : {0.01, 0.3}) {
      const RockPair<3> pair(basalt, 0.02, *other, radius, 1, 1);
      const auto law = rvelab::HertzMindlinLaw::mix(grain_of(basalt), 0.02, grain_of(*other), radius, 1.0);
      CHECK(pair.k == Approx(law.kn).epsilon(1e-14));
      CHECK(pair.kt == Approx(law.kt).epsilon(1e-14));
      CHECK(pair.friction == 0.3);
    }
  }
}

TEST_CASE("an oblique collision of spinning spheres is that of LAMMPS, but for where the slip is taken") {
  const auto found = compare_with_record("obl_hm_stick_mindlin_rescale_force");
  CHECK(found.velocity < 1e-9 * found.largest_velocity);
  CHECK(found.spin < 1e-9 * found.largest_spin);
  CHECK(found.rock_velocity < 1e-9 * found.largest_velocity);
  CHECK(found.rock_spin < 1e-9 * found.largest_spin);
  // Arms of the slip differ by overlap/(2 r), 2 %.
  CHECK(found.from_record_velocity < 0.02 * found.largest_velocity);
  CHECK(found.from_record_spin < 0.02 * found.largest_spin);
}

TEST_CASE("kinetic energy, springs and losses of a collision sum to what came in, the better the smaller the step") {
  const auto stuck = books_of(100, 1, 1), stuck_finer = books_of(100, 1, 2);
  const auto slides = books_of(0.1, 1, 1), slides_finer = books_of(0.1, 1, 2);
  const auto damped = books_of(0.1, 0.5, 1), damped_finer = books_of(0.1, 0.5, 2);
  CHECK(stuck.worst < 1e-3 * stuck.kinetic);
  CHECK(stuck.worst > 3 * stuck_finer.worst);
  CHECK(slides.worst < 1e-3 * slides.kinetic);
  CHECK(slides.worst > 2 * slides_finer.worst);
  CHECK(damped.worst < 1e-3 * damped.kinetic);
  CHECK(damped.worst > 2 * damped_finer.worst);
  CHECK(slides.lost > 1e-3 * slides.kinetic);
  CHECK(damped.lost > 1.5 * slides.lost);
}

TEST_CASE("two and three superquadrics that collide keep momentum, angular momentum and their books") {
  for (const int count : {2, 3}) {
    for (const double restitution : {1.0, 0.5}) {
      CAPTURE(count, restitution);
      auto rocks = flying_rocks(count, 0.4, restitution);
      const Vec<3> momentum = momentum_of<3>(rocks), angular = angular_momentum_of(rocks);
      const double scale = rocks.all[1].body.mass, energy = rocks.energy(Vec<3>::Zero()).kinetic;
      double worst = 0;
      long touched = 0, pairs = 0;
      for (int step = 0; step < 300; ++step) {
        rocks.advance(in_the_open, Vec<3>::Zero(), 0, 1e-3);
        touched += rocks.touching;
        pairs = std::max(pairs, long(rocks.pairs.size()));
        worst = std::max(worst, std::abs(rocks.energy(Vec<3>::Zero()).residual));
      }
      CHECK(touched > 0);
      CHECK((momentum_of<3>(rocks) - momentum).norm() < 1e-12 * scale);
      CHECK((angular_momentum_of(rocks) - angular).norm() < 1e-12 * scale * 0.1);
      CHECK(worst < 1e-2 * energy);
    }
  }
}
