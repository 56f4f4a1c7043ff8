// Bodies with a shape of their own (ellipsoids, superellipsoids) in the cell: laws of nature, spheres, crystals whose
// stress is known, frames, lists, bits.
#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <tuple>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/solid_linear.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/specimen/solids.hpp"
#include "rvelab/specimen/specimen_check.hpp"
#include "tests/solver/instruction_set.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

Turn any_turn(std::mt19937_64& generator) {
  const auto uniform = [&] { return 2 * double(generator() >> 11) / 9007199254740992.0 - 1; };
  const double w = uniform(), x = uniform(), y = uniform(), z = uniform();
  return normalised(Turn{w, {x, y, z}});
}

Material solid_material(double friction) {
  Material m = linear_material(1e6, 5e5, friction);
  m.young_modulus = 1e8;
  m.poisson_ratio = 0.2;
  return m;
}

constexpr Superellipsoid ellipsoid{1.25, 1, 0.8, 2, 2}, blocky{1.2, 1, 0.9, 4, 3};

Superellipsoid times_as_large(Superellipsoid s, double factor) {
  s.a *= factor;
  s.b *= factor;
  s.c *= factor;
  return s;
}

/// Turned anyhow at the sites of a crystal, brought to rest under pressure.
Specimen pressed_solids(int side, const Superellipsoid& shape, std::uint64_t seed, Law law = Law::linear_stiffness,
                        double friction = 0.5) {
  const double spacing = 0.01;
  Specimen s = empty_specimen(Shape::superellipsoid, side * spacing, solid_material(friction), law);
  s.solver.max_overlap_ratio = 0.8;
  std::mt19937_64 generator(seed);
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i)
        add_superellipsoid(s, times_as_large(shape, 0.5 * spacing),
                           Vector3(i, j, k) * spacing - 0.5 * (side - 1) * spacing * Vector3::Ones(),
                           any_turn(generator));
  Rve rve(s);
  rve.relax(1e-4, 20'000);
  for (int round = 0; round < 60 && mean_pressure(rve.stress(), 3) < 5e3; ++round) {
    rve.apply(-5e-3 * Matrix3::Identity(), 0);
    rve.relax(1e-4, 5'000);
  }
  rve.relax(1e-6, 50'000);
  return rve.specimen();
}

Matrix3 strained(double xx, double yy, double xy) {
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 0) = xx;
  gradient(1, 1) = yy;
  gradient(0, 1) = xy;
  return gradient;
}

/// Momentum, angular momentum about the origin and kinetic energy.
struct Conserved {
  Vector3 momentum = Vector3::Zero(), angular = Vector3::Zero();
  double energy = 0;
};
Conserved conserved_in(const Specimen& s) {
  Conserved sum;
  for (const Body& body : s.bodies) {
    const double mass = s.materials[0].density * body.volume;
    const Matrix3 axes = axes_of(body.orientation);
    const Vector3 spun = mass * (axes * body.gyration.asDiagonal() * axes.transpose()) * body.spin;
    sum.momentum += mass * body.velocity;
    sum.angular += mass * body.position.cross(body.velocity) + spun;
    sum.energy += 0.5 * (mass * body.velocity.squaredNorm() + body.spin.dot(spun));
  }
  return sum;
}

/// Two that fly at each other off centre and turn.
Specimen two_in_flight(const Superellipsoid& shape, Law law, double friction) {
  Specimen s = empty_specimen(Shape::superellipsoid, 0.2, solid_material(friction), law);
  std::mt19937_64 generator(7);
  add_superellipsoid(s, times_as_large(shape, 0.01), {-0.02, 0.003, 0}, any_turn(generator));
  add_superellipsoid(s, times_as_large(shape, 0.012), {0.02, -0.004, 0}, any_turn(generator));
  s.bodies[0].velocity = {1, 0.1, 0};
  s.bodies[1].velocity = -s.bodies[0].volume / s.bodies[1].volume * s.bodies[0].velocity;
  s.bodies[0].spin = {10, -15, 20};
  s.state.last_step.loading = Loading::at_rate;
  return s;
}

}  // namespace

TEST_CASE("Superellipsoids that meet keep momentum, angular momentum and energy") {
  // Without friction the energy too: what tangential springs hold ends as the contact opens.
  for (const auto& [shape, law, friction] : {std::tuple{ellipsoid, Law::linear_stiffness, 0.5},
                                             {ellipsoid, Law::hertz_mindlin, 0.0},
                                             {blocky, Law::linear_stiffness, 0.0},
                                             {blocky, Law::hertz_mindlin, 0.5}}) {
    Specimen s = two_in_flight(shape, law, friction);
    s.solver.fixed_time_step = 2e-7;
    Rve rve(s);
    const Conserved before = conserved_in(s);
    bool touched = false;
    double error = 0;
    for (int k = 0; k < 50; ++k) {
      rve.apply(Matrix3::Zero(), 1e-3);
      const Specimen now = rve.specimen();
      touched = touched || !rve.network().contacts.empty() || now.bodies[0].velocity[0] < 0.9;
      const Conserved held = conserved_in(now);
      CHECK(held.momentum.norm() < 1e-12 * s.materials[0].density * s.bodies[0].volume);
      error = std::max(error, (held.angular - before.angular).norm() / before.angular.norm());
    }
    const double change = conserved_in(rve.specimen()).energy / before.energy - 1;
    CAPTURE(shape.e, int(law), friction, touched, error, change);
    CHECK(touched);
    CHECK(rve.network().contacts.empty());
    CHECK(error < 1e-10);
    CHECK(change < 2e-4);
    if (friction == 0) CHECK(change > -2e-4);
  }
}

TEST_CASE("A sphere as a superellipsoid is the sphere: the same path to 1e-10 of the pressure") {
  for (const bool rolling : {false, true}) {
    Material m = linear_material(1e6, 5e5, 0.5);
    m.rolling_stiffness = rolling ? 0.5 : 0;
    m.rolling_friction = rolling ? 0.1 : 0;
    Specimen start = disordered(Shape::sphere, 6, m, Law::linear_stiffness, 0.52, 3);
    start.contact.rolling = rolling;
    Rve rest(start);
    rest.relax(1e-6, 50'000);
    Specimen alone = rest.specimen();
    alone.contacts.clear();
    alone.state = SolverState{};
    for (auto* v : {&alone.grains.velocity, &alone.grains.spin}) std::fill(v->begin(), v->end(), Vector3::Zero());
    alone.solver.fixed_substeps = 50;
    Specimen solids = alone;
    solids.shape = Shape::superellipsoid;
    solids.grains = Grains{};
    std::mt19937_64 generator(2);
    for (std::size_t g = 0; g < alone.grains.size(); ++g) {
      const double r = alone.grains.radius[g];
      add_superellipsoid(solids, {r, r, r, 2, 2}, alone.grains.position[g], any_turn(generator));
    }
    Rve a(alone), b(solids);
    const double pressure = mean_pressure(a.stress(), 3);
    REQUIRE(pressure > 0);
    CHECK((a.stress() - b.stress()).norm() < 1e-10 * pressure);
    for (int k = 0; k < 4; ++k) {
      a.apply(strained(-5e-5, 2e-5, 3e-5), 0);
      b.apply(strained(-5e-5, 2e-5, 3e-5), 0);
      CAPTURE(rolling, k, a.stress() - b.stress(), pressure);
      CHECK((a.stress() - b.stress()).norm() < 1e-10 * pressure);
    }
    CHECK(std::abs(void_ratio(a.network()) - void_ratio(b.network())) < 1e-12);
    CHECK(coordination_number(a.network()) == coordination_number(b.network()));
    const Eigen::MatrixXd of_spheres = elastic_tangent(a.network()), of_solids = elastic_tangent(b.network());
    CHECK((of_spheres - of_solids).norm() < 1e-8 * of_spheres.norm());
  }
}

TEST_CASE("A crystal of superellipsoids that touch at their tips bears what its springs say") {
  // Half axes a b c along the edges of the cell: sigma_kk = -f_k s_k/V with f_k = kn (2 a_k - s_k).
  for (const auto& [e, n] : {std::pair{2.0, 2.0}, {4.0, 6.0}}) {
    const Vector3 half(0.006, 0.005, 0.004), overlap(3e-6, 2e-6, 4e-6);
    Specimen s = empty_specimen(Shape::superellipsoid, 1, solid_material(0.5), Law::linear_stiffness);
    s.cell.lattice = (2 * half - overlap).asDiagonal();
    add_superellipsoid(s, {half[0], half[1], half[2], e, n}, Vector3::Zero(), Turn{});
    s.solver.fixed_substeps = 200;
    s.solver.min_height = 0.007;
    Rve rve(s);
    const double kn = s.materials[0].normal_stiffness, kt = s.materials[0].tangential_stiffness;
    const auto known = [&](const Vector3& edges) -> Vector3 {
      return -kn * (2 * half - edges).cwiseProduct(edges) / edges.prod();
    };
    const Vector3 edges = s.cell.lattice.diagonal();
    CHECK((rve.stress().diagonal() - known(edges)).norm() < 1e-9 * known(edges).norm());
    CHECK(coordination_number(rve.network()) == 6);
    const Eigen::MatrixXd affine = affine_tangent(rve.network());
    CHECK(affine(0, 0) == Approx(kn * edges[0] * edges[0] / edges.prod()).epsilon(1e-9));
    // Engineering shear xy of the contacts along x and y, springs kt across each; the stress there is adds a
    // thousandth.
    CHECK(affine(5, 5) == Approx(0.25 * kt * (edges[0] * edges[0] + edges[1] * edges[1]) / edges.prod()).epsilon(2e-3));
    rve.apply(strained(-1e-4, 5e-5, 0), 0);
    const Vector3 pressed(edges[0] * (1 - 1e-4), edges[1] * (1 + 5e-5), edges[2]);
    CAPTURE(e, rve.stress().diagonal(), known(pressed));
    CHECK((rve.stress().diagonal() - known(pressed)).norm() < 1e-8 * known(pressed).norm());
  }
}

TEST_CASE("A block slides over another as a box: the impulse is on the cone of friction") {
  // Faces meet flat, fast across and slow along the normal: f_t = mu f_n throughout.
  const double friction = 0.3;
  for (const double exponent : {8.0, 20.0}) {
    Specimen s = empty_specimen(Shape::superellipsoid, 0.2, solid_material(friction), Law::linear_stiffness);
    const Superellipsoid block = {0.01, 0.01, 0.005, exponent, exponent};
    add_superellipsoid(s, block, {0, 0, -0.00502}, Turn{});
    add_superellipsoid(s, block, {-0.001, 0, 0.00502}, Turn{});
    s.bodies[1].velocity = {0.2, 0, -0.02};
    s.bodies[0].velocity = -s.bodies[1].velocity;
    s.state.last_step.loading = Loading::at_rate;
    s.solver.fixed_time_step = 1e-6;
    Rve rve(s);
    for (int k = 0; k < 40 && rve.specimen().bodies[1].velocity[2] < 0; ++k) rve.apply(Matrix3::Zero(), 1e-4);
    const Vector3 gained = rve.specimen().bodies[1].velocity - s.bodies[1].velocity;
    CAPTURE(exponent, gained.transpose());
    CHECK(gained[2] > 0.02);
    CHECK(-gained[0] / gained[2] == Approx(friction).epsilon(0.02));
    CHECK(std::abs(gained[1]) < 1e-6 * gained[2]);
  }
}

TEST_CASE("Superellipsoids bear stress in balance; sums, network and a list made anew agree") {
  for (const Superellipsoid& shape : {ellipsoid, blocky}) {
    const Specimen packed = pressed_solids(3, shape, 11);
    Rve rve(packed);
    const double pressure = mean_pressure(rve.stress(), 3);
    CAPTURE(shape.e, pressure, rve.unbalanced_ratio());
    CHECK(pressure > 1e3);
    CHECK(rve.unbalanced_ratio() < 1e-5);
    const Network network = rve.network();
    CHECK((contact_stress(network) - rve.contact_stress()).norm() < 1e-12 * pressure);
    CHECK((rve.stress() - rve.stress().transpose()).norm() < 1e-3 * pressure);
    CHECK(unbalanced_force_ratio(network) < 1e-4);
    CHECK(unbalanced_torque_ratio(network) < 1e-4);
    double solid = 0;
    for (const Body& body : packed.bodies) solid += body.volume;
    CHECK(std::abs(void_ratio(network) - (rve.cell().volume() - solid) / solid) < 1e-10);
    // Large shear: wrapped and reduced cells, grains that turn within their list.
    Specimen hurried = rve.specimen();
    hurried.solver.fixed_substeps = 300;
    rve = Rve(hurried);
    for (int k = 0; k < 4; ++k) {
      rve.apply(strained(0, 0, 0.1), 0);
      const Specimen now = rve.specimen();
      check_specimen(now);
      Specimen anew = now;
      anew.state.list = {};
      const Rve listed_anew(anew);
      CHECK((listed_anew.contact_stress() - rve.contact_stress()).norm() < 1e-10 * pressure);
      CHECK(listed_anew.network().contacts.size() == rve.network().contacts.size());
    }
    CHECK(std::abs(orientation_fabric(rve.network()).trace() - 1) < 1e-12);
  }
}

TEST_CASE("A rigid rotation leaves superellipsoids as they were") {
  Rve rve(pressed_solids(3, blocky, 5));
  const Matrix3 before = rve.stress();
  const Matrix3 turn = Eigen::AngleAxisd(0.7, Vector3(1, -2, 0.5).normalized()).toRotationMatrix();
  rve.apply(turn - Matrix3::Identity(), 0);
  CHECK((rve.stress() - turn * before * turn.transpose()).norm() < 1e-12 * before.norm());
}

TEST_CASE("Superellipsoids go on with the same bits after a snapshot, a reverted trial and a release") {
  for (const auto& [shape, dt] : {std::pair{ellipsoid, 0.0}, {blocky, 0.0}, {blocky, 1e-4}}) {
    Rve rve(pressed_solids(3, shape, 4, Law::hertz_mindlin));
    rve.apply(strained(-1e-3, 5e-4, 2e-3), dt);
    Rve other(rve.specimen());
    Rve restored(disordered(Shape::sphere, 3, linear_material(1e6, 5e5, 0.5), Law::linear_stiffness, 0.4, 1));
    restored.restore(rve.save());
    rve.attempt(strained(2e-3, -1e-3, 0), dt);
    rve.revert();
    CHECK(rve.save() == other.save());
    rve.release();
    for (int k = 0; k < 3; ++k)
      for (Rve* each : {&rve, &other, &restored}) each->apply(strained(-1e-3, 5e-4, 0.005), dt);
    CHECK(rve.save() == other.save());
    CHECK(rve.save() == restored.save());
  }
}

TEST_CASE("Superellipsoids have the same bits by every instruction set") {
  for (const Superellipsoid& shape : {ellipsoid, blocky}) {
    Specimen s = pressed_solids(3, shape, 6, Law::hertz_mindlin);
    s.solver.fixed_substeps = 60;
    std::vector<std::byte> scalar;
    for (const char* name : {"scalar", "baseline", "v3", "v4"}) {
      CAPTURE(name, shape.e);
      const InstructionSet chosen(name);
      try {
        Rve rve(s);
        rve.apply(strained(-1e-3, 5e-4, 3e-3), 0);
        if (scalar.empty()) scalar = rve.save();
        CHECK(bool(rve.save() == scalar));
      } catch (const InputError&) {
        WARN(std::string("not on this processor: ") + name);
      }
    }
  }
}

TEST_CASE("A contact of superellipsoids, linearised, is the difference of two contacts nearby") {
  Specimen s = empty_specimen(Shape::superellipsoid, 0.2, solid_material(0.5), Law::linear_stiffness);
  std::mt19937_64 generator(5);
  add_superellipsoid(s, times_as_large(blocky, 0.01), {0, 0, 0}, any_turn(generator));
  add_superellipsoid(s, times_as_large(ellipsoid, 0.012), {0.017, 0.008, 0.004}, any_turn(generator));
  s.contact.rolling = false;
  s.solver.max_overlap_ratio = 1;
  const Network network = Rve(s).network();
  REQUIRE(network.contacts.size() == 1);
  ContactState contact = network.contacts[0];
  contact.tangential_stiffness = 0;  // the history of a specimen does not follow: the normal force alone
  const LinearOutlineContact linear =
      linearised_solids(contact, network.grains[0], network.axes[0], network.grains[1], network.axes[1]);
  const double length = 1e-7, angle = 1e-5;
  for (int k = 0; k < 9; ++k) {
    const auto moved = [&](double sign) {
      Specimen m = s;
      const Vector3 by = sign * Vector3::Unit(k % 3);
      if (k < 3) {
        m.bodies[1].position += length * by;
        m.grains.position[1] = m.bodies[1].position;
      } else {
        Turn& q = m.bodies[k < 6 ? 0 : 1].orientation;
        q = normalised(after(Turn{1, 0.5 * angle * by}, q));
      }
      return Rve(m).network();
    };
    const Network ahead = moved(1), back = moved(-1);
    const double step = 2 * (k < 3 ? length : angle);
    const Vector3 force = (ahead.contacts[0].force() - back.contacts[0].force()) / step;
    const Vector3 torque_i = (ahead.grains[0].torque - back.grains[0].torque) / step;
    const Vector3 torque_j = (ahead.grains[1].torque - back.grains[1].torque) / step;
    const double size = linear.law.force.col(k < 3 ? 0 : 4).norm();
    CAPTURE(k, force.transpose(), linear.law.force.col(k).transpose());
    CHECK((force - linear.law.force.col(k)).norm() < 1e-4 * size);
    CHECK((torque_i - linear.law.torque_i.col(k)).norm() < 1e-4 * 0.01 * size);
    CHECK((torque_j - linear.law.torque_j.col(k)).norm() < 1e-4 * 0.01 * size);
  }
}

TEST_CASE("The elastic tangent of superellipsoids is what a small increment without slip answers") {
  Specimen s = pressed_solids(3, ellipsoid, 21);
  s.materials[0].friction = 1e6;
  s.solver.target_unbalanced = 1e-9;
  Rve rve(s);
  rve.relax(1e-9, 200'000);
  const Eigen::MatrixXd tangent = elastic_tangent(rve.network());
  const double strain = 1e-6;
  Rve pressed = rve;
  const Matrix3 before = rve.stress();
  pressed.apply(strained(-strain, 0, 0), 0);
  pressed.relax(1e-9, 200'000);
  const double measured = (before(0, 0) - pressed.stress()(0, 0)) / strain;
  CAPTURE(measured, tangent(0, 0));
  CHECK(std::abs(measured / tangent(0, 0) - 1) < 0.01);
}

TEST_CASE("What is no specimen of superellipsoids is refused") {
  Specimen s = empty_specimen(Shape::superellipsoid, 0.2, solid_material(0.5), Law::linear_stiffness);
  add_superellipsoid(s, times_as_large(blocky, 0.01), {0, 0, 0}, Turn{});
  add_superellipsoid(s, times_as_large(ellipsoid, 0.01), {0.05, 0, 0}, Turn{});
  CHECK_NOTHROW(Rve(s));
  const auto refuses = [&](const auto& change, const char* text) {
    Specimen wrong = s;
    change(wrong);
    CHECK_THROWS_WITH(Rve(wrong), Contains(text));
  };
  refuses([](Specimen& w) { w.grains.exponent_z[0] = 1.5; }, "exponents 2 to 20");
  refuses([](Specimen& w) { w.grains.half_x[1] = 0.2; }, "10 times the shortest");
  refuses([](Specimen& w) { w.grains.half_x[1] *= 1.1; }, "radius_m");
  refuses([](Specimen& w) { w.bodies[1].volume *= 1.1; }, "volume_m3");
  refuses([](Specimen& w) { w.bodies[1].gyration[0] *= 1.1; }, "gyration_m2");
  refuses([](Specimen& w) { w.bodies.pop_back(); }, "one for each grain");
  refuses([](Specimen& w) { w.members[0].offset = {1e-3, 0, 0}; }, "offset_m");
  refuses([](Specimen& w) { w.bodies[0].orientation.w = 1.1; }, "orientation");
  refuses([](Specimen& w) { w.contact.slip = Slip::full_radius; }, "slip");
  Rve rve(s);
  const std::vector<Vector3> none(rve.size(), Vector3::Zero());
  CHECK_THROWS_AS(rve.set_velocities(none, none), InputError);
}
