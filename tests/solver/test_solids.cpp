// Bodies with a shape of their own (ellipsoids, superellipsoids) in the cell: laws of nature, spheres, crystals whose
// stress is known, frames, lists, bits.
#include <cmath>
#include <limits>
#include <tuple>

#include "rvelab/error.hpp"
#include "rvelab/measure/solid_linear.hpp"
#include "rvelab/specimen/specimen_check.hpp"
#include "tests/bodies.hpp"
#include "tests/solver/instruction_set.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("Superellipsoids that meet keep momentum, angular momentum and energy") {
  for (const auto& [shape, law, friction] : {std::tuple{ellipsoid, Law::linear_stiffness, 0.5},
                                             {ellipsoid, Law::hertz_mindlin, 0.0},
                                             {ellipsoid, Law::hertz_rough, 0.0},
                                             {ellipsoid, Law::cones, 0.0},
                                             {blocky, Law::linear_stiffness, 0.0},
                                             {blocky, Law::hertz_mindlin, 0.5}}) {
    CAPTURE(shape.e);
    const auto add = [&of = shape](Specimen& s, double size, const Vector3& x, const Turn& turn) {
      add_superellipsoid(s, times_as_large(of, size), x, turn);
    };
    check_impact(two_in_flight(Shape::superellipsoid, law, friction, add), 0.9);
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
    const Specimen alone = made_anew(rest.specimen());
    Specimen solids = alone;
    solids.shape = Shape::superellipsoid;
    solids.grains = Grains{};
    std::mt19937_64 generator(2);
    for (std::size_t g = 0; g < alone.grains.size(); ++g) {
      const double r = alone.grains.radius[g];
      add_superellipsoid(solids, {r, r, r, 2, 2}, alone.grains.position[g], any_turn(3, generator));
    }
    Rve a(alone), b(solids);
    CAPTURE(rolling);
    check_same_path(a, b, 4, 1e-10);
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
    Specimen s = empty_specimen(Shape::superellipsoid, 1, body_material(0.5), Law::linear_stiffness);
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
    rve.apply(gradient(-1e-4, 0, 0, 5e-5), 0);
    const Vector3 pressed(edges[0] * (1 - 1e-4), edges[1] * (1 + 5e-5), edges[2]);
    CAPTURE(e, rve.stress().diagonal(), known(pressed));
    CHECK((rve.stress().diagonal() - known(pressed)).norm() < 1e-8 * known(pressed).norm());
  }
}

TEST_CASE("A block slides over another as a box: the impulse is on the cone of friction") {
  // Faces meet flat, fast across and slow along the normal: f_t = mu f_n throughout.
  const double friction = 0.3;
  for (const double exponent : {8.0, 20.0}) {
    Specimen s = empty_specimen(Shape::superellipsoid, 0.2, body_material(friction), Law::linear_stiffness);
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
    CAPTURE(shape.e);
    const double pressure = mean_pressure(rve.stress(), 3);
    check_balance(rve, packed.bodies);
    // Large shear: wrapped and reduced cells, grains that turn within their list.
    Specimen hurried = rve.specimen();
    hurried.solver.fixed_substeps = 300;
    rve = Rve(hurried);
    for (int k = 0; k < 4; ++k) {
      rve.apply(gradient(0, 0.1, 0, 0), 0);
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
  check_rigid_rotation(Rve(pressed_solids(3, blocky, 5)));
}

TEST_CASE("Superellipsoids go on with the same bits after a snapshot, a reverted trial and a release") {
  for (const auto& [shape, dt] : {std::pair{ellipsoid, 0.0}, {blocky, 0.0}, {blocky, 1e-4}})
    check_same_bits(pressed_solids(3, shape, 4, Law::hertz_mindlin), dt, 0.005);
  for (const Superellipsoid& shape : {ellipsoid, blocky}) {
    Specimen s = pressed_solids(3, shape, 4, Law::hertz_mindlin);
    s.contact.hertz_radius = HertzRadius::curvature;
    check_same_bits(at_rest(s, 1e-3).specimen(), 0, 0.005);
  }
}

TEST_CASE("Superellipsoids have the same bits by every instruction set") {
  for (const auto& [shape, radius] : {std::pair{ellipsoid, HertzRadius::equivalent},
                                      {blocky, HertzRadius::equivalent},
                                      {ellipsoid, HertzRadius::curvature},
                                      {blocky, HertzRadius::curvature}}) {
    Specimen s = pressed_solids(3, shape, 6, Law::hertz_mindlin);
    s.contact.hertz_radius = radius;
    check_instruction_sets(s);
  }
}

TEST_CASE("A contact of superellipsoids, linearised, is the difference of two contacts nearby") {
  const bool curvature = GENERATE(false, true);
  Specimen s = empty_specimen(Shape::superellipsoid, 0.2, body_material(0.5),
                              curvature ? Law::hertz_mindlin : Law::linear_stiffness);
  if (curvature) s.contact.hertz_radius = HertzRadius::curvature;
  std::mt19937_64 generator(5);
  add_superellipsoid(s, times_as_large(blocky, 0.01), {0, 0, 0}, any_turn(3, generator));
  add_superellipsoid(s, times_as_large(ellipsoid, 0.012), {0.017, 0.008, 0.004}, any_turn(3, generator));
  s.contact.rolling = false;
  s.solver.max_overlap_ratio = 1;
  const Network network = Rve(s).network();
  REQUIRE(network.contacts.size() == 1);
  ContactState contact = network.contacts[0];
  contact.tangential_stiffness = 0;  // the history of a specimen does not follow: the normal force alone
  const LinearOutlineContact linear = linearised_solids(contact, network.grains[0], network.axes[0], network.grains[1],
                                                        network.axes[1], s.contact.hertz_radius);
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
  check_elastic_tangent(pressed_solids(3, ellipsoid, 21));
}

TEST_CASE("What is no specimen of superellipsoids is refused") {
  Specimen s = empty_specimen(Shape::superellipsoid, 0.2, body_material(0.5), Law::linear_stiffness);
  add_superellipsoid(s, times_as_large(blocky, 0.01), {0, 0, 0}, Turn{});
  add_superellipsoid(s, times_as_large(ellipsoid, 0.01), {0.05, 0, 0}, Turn{});
  CHECK_NOTHROW(Rve(s));
  const auto refuses = [&](const auto& change, const char* text) {
    Specimen wrong = s;
    change(wrong);
    CHECK_THROWS_WITH(Rve(wrong), Contains(text));
  };
  refuses([](Specimen& w) { w.grains.exponent_z[0] = 1.5; }, "exponents 2 to 20");
  refuses([](Specimen& w) { w.grains.half_y[1] = std::numeric_limits<double>::quiet_NaN(); },
          "specimen: grains/half_y_m[1] of grain 1 = nan is out of range; allowed: > 0 m, finite; correct it");
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
