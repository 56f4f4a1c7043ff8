// Ellipses in the solver: discs written as ellipses, bounds, turns, and what is refused. Collisions:
// test_colliding_ellipses.cpp.
#include <Eigen/Eigenvalues>
#include <functional>

#include "rvelab/error.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// The same discs, written as ellipses that are turned anyhow.
Specimen as_ellipses(Specimen s) {
  s.shape = Shape::ellipse;
  for (std::size_t g = 0; g < s.grains.size(); ++g) {
    s.grains.semi_major.push_back(s.grains.radius[g]);
    s.grains.semi_minor.push_back(s.grains.radius[g]);
    s.grains.orientation.emplace_back(std::cos(double(g)), std::sin(double(g)), 0);
  }
  return s;
}

/// The same ellipses with the ratio b/a of `aspect` and their areas.
Specimen of_aspect(Specimen s, double aspect) {
  for (std::size_t g = 0; g < s.grains.size(); ++g) {
    s.grains.semi_major[g] = s.grains.radius[g] / std::sqrt(aspect);
    s.grains.semi_minor[g] = s.grains.radius[g] * std::sqrt(aspect);
  }
  s.solver.min_height = 1e-3;
  return s;
}

/// Largest frequency of the springs of a network, rad/s, from their energy 2 E = kn (n.v)^2 + kt (t.v)^2 + kr w^2 with
/// v the displacement of j less that of i at the contact point and w the difference of the rotations.
double largest_frequency(const Network& net) {
  const auto size = Eigen::Index(3 * net.grains.size());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size, size);
  for (const ContactState& c : net.contacts) {
    const Vector3 across(-c.normal[1], c.normal[0], 0);
    const auto add = [&](double k, const Vector3& n, double moment) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
      row.segment<2>(3 * c.j) += n.head<2>();
      row.segment<2>(3 * c.i) -= n.head<2>();
      row[3 * c.j + 2] += c.arm_j.cross(n)[2] + moment;
      row[3 * c.i + 2] -= c.arm_i.cross(n)[2] + moment;
      stiffness += k * row * row.transpose();
    };
    add(c.normal_stiffness, c.normal, 0);
    add(c.tangential_stiffness, across, 0);
    add(c.rolling_stiffness, Vector3::Zero(), 1);
  }
  Eigen::VectorXd scale(size);
  for (Eigen::Index g = 0; g < size / 3; ++g) {
    scale.segment<2>(3 * g).setConstant(1 / std::sqrt(net.grains[std::size_t(g)].mass));
    scale[3 * g + 2] = 1 / std::sqrt(net.grains[std::size_t(g)].inertia);
  }
  const Eigen::MatrixXd scaled = scale.asDiagonal() * stiffness * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled, Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues().maxCoeff());
}

}  // namespace

TEST_CASE("The bound of the largest frequency of ellipses lies above it, and not far") {
  const double aspect = GENERATE(0.1, 0.4, 0.9), ratio = GENERATE(0.0, 0.2, 3.0);
  const bool rolling = GENERATE(false, true);
  if (rolling && ratio == 0) return;
  Material m = linear_material(2e6, ratio * 2e6, 0.5);
  m.rolling_stiffness = 0.5;
  m.rolling_friction = 0.1;
  Specimen s = disordered(Shape::ellipse, 4, m, Law::linear_stiffness, 0.5, 3);
  s.solver.max_overlap_ratio = 10;
  s.contact.rolling = rolling;
  const Rve rve(of_aspect(s, aspect));
  const double exact = largest_frequency(rve.network()), bound = 2 / rve.critical_time_step();
  CAPTURE(aspect, ratio, rolling, bound, exact);
  CHECK(bound >= exact * (1 - 1e-12));
  CHECK(bound <= 4 * exact);
}

TEST_CASE("The bound of the largest frequency holds with Hertz's radius from curvature") {
  const double aspect = GENERATE(0.1, 0.3, 0.743);
  Specimen s = disordered(Shape::ellipse, 6, material_of_every_law(), Law::hertz_mindlin, 0.5, 3);
  s.contact.hertz_radius = HertzRadius::curvature;
  s.solver.max_overlap_ratio = 10;
  const Rve rve(of_aspect(s, aspect));
  const double exact = largest_frequency(rve.network()), bound = 2 / rve.critical_time_step();
  CAPTURE(aspect, bound, exact);
  CHECK(bound >= exact * (1 - 1e-12));
  CHECK(bound <= 4 * exact);
}

TEST_CASE("Discs written as ellipses have the forces of discs") {
  const Law law = GENERATE(Law::linear_stiffness, Law::linear, Law::hertz_mindlin);
  const bool rolling = GENERATE(false, true);
  const Dashpot dashpot = GENERATE(Dashpot::none, Dashpot::restitution);
  CAPTURE(name(law), rolling, name(dashpot));
  Specimen s = disordered(Shape::disc, 8, material_of_every_law(), law, 0.53, 4);
  s.contact.rolling = rolling;
  s.damping.dashpot = dashpot;
  s.damping.restitution = 0.6;
  s.damping.tangential_ratio = 0.5;
  s.solver.fixed_substeps = 10;  // no choice that a last bit could turn
  Specimen same = as_ellipses(s);
  if (law == Law::hertz_mindlin) same.contact.hertz_radius = GENERATE(HertzRadius::equivalent, HertzRadius::curvature);
  Rve discs(s), ellipses(same);
  CHECK(ellipses.critical_time_step() == Approx(discs.critical_time_step()).epsilon(1e-12));
  for (const double dt : {0.0, 10 * discs.critical_time_step()}) {
    discs.apply(gradient(-2e-4, 5e-4, -3e-4, -1e-4), dt);
    ellipses.apply(gradient(-2e-4, 5e-4, -3e-4, -1e-4), dt);
    const Network a = discs.network(), b = ellipses.network();
    REQUIRE(a.contacts.size() == b.contacts.size());
    double largest_force = 0, farthest = 0, turned = 0;
    for (std::size_t k = 0; k < a.contacts.size(); ++k) {
      largest_force = std::max(largest_force, a.contacts[k].force().norm());
      farthest = std::max(farthest, (a.contacts[k].force() - b.contacts[k].force()).norm());
    }
    for (std::size_t g = 0; g < a.grains.size(); ++g)
      turned = std::max(turned, (a.grains[g].torque - b.grains[g].torque).norm() / a.grains[g].radius);
    CHECK(farthest < 1e-12 * largest_force);
    CHECK(turned < 1e-12 * largest_force);
    CHECK(largest(discs.stress() - ellipses.stress()) < 1e-12 * largest(discs.stress()));
  }
}

TEST_CASE("A free ellipse turns by its spin, in a cell that turns too") {
  Specimen s = empty_specimen(Shape::ellipse, 3, linear_material(1e6, 0, 0));
  add_ellipse(s, {0.1, 0.2, 0}, 0.2, 0.1, 0.3);
  s.state.last_step.loading = Loading::at_rate;
  s.solver.fixed_time_step = 1e-4;
  for (const double cell_angle : {0.0, 0.4}) {
    Rve rve(s);
    rve.set_velocities({Vector3::Zero()}, {Vector3(0, 0, 2)});
    const Matrix3 step = rotation_about_z(cell_angle / 100) - Matrix3::Identity();
    for (int k = 0; k < 100; ++k) rve.apply(step, 5e-3);
    const Network net = rve.network();
    const Vector3 axis = net.cell.rotation * net.grains[0].orientation;
    CHECK(axis.norm() == Approx(1).margin(1e-14));
    // The whole spin is the same in both: a turning frame does not take the grain with it once it turns steadily.
    const double whole = net.grains[0].spin[2] + net.mean_spin[2];
    CHECK(std::atan2(axis[1], axis[0]) == Approx(std::remainder(0.3 + whole * 0.5, 2 * pi)).margin(5e-3));
  }
}

TEST_CASE("A rigid turn of the cell at rest turns ellipses with it and leaves their contacts as they were") {
  const Rve start(disordered(Shape::ellipse, 6, material_of_every_law(), Law::linear_stiffness, 0.53, 8));
  Rve turned(start);
  turned.apply(rotation_about_z(0.7) - Matrix3::Identity(), 0);
  const Network a = start.network(), b = turned.network();
  REQUIRE(a.contacts.size() == b.contacts.size());
  for (std::size_t k = 0; k < a.contacts.size(); ++k) CHECK(a.contacts[k].overlap == b.contacts[k].overlap);
  const Vector3 before = a.cell.rotation * a.grains[5].orientation, after = b.cell.rotation * b.grains[5].orientation;
  CHECK((rotation_about_z(0.7) * before - after).norm() < 1e-14);
}

TEST_CASE("Ellipses of impossible axes, orientation or slip are refused by name") {
  const Specimen good = disordered(Shape::ellipse, 3, material_of_every_law(), Law::linear_stiffness, 0.45, 1);
  CHECK_NOTHROW(Rve(good));
  const auto refused = [&](const std::function<void(Specimen&)>& change, const std::string& text) {
    Specimen s = good;
    change(s);
    CHECK_THROWS_WITH(Rve(s), Catch::Contains(text));
  };
  refused([](Specimen& s) { s.grains.semi_minor[2] *= 1.01; }, "sqrt(semi_major semi_minor)");
  refused([](Specimen& s) { std::swap(s.grains.semi_major, s.grains.semi_minor); }, "semi_major >= semi_minor > 0");
  refused([](Specimen& s) { s.grains.semi_major[0] *= 4, s.grains.semi_minor[0] /= 4; }, "at most 10 times as long");
  refused([](Specimen& s) { s.grains.orientation[4] *= 1.001; },
          "grains/orientation[4] of grain 5 has the length 1.001; allowed: 1");
  refused([](Specimen& s) { s.grains.orientation.pop_back(); },
          "grains/orientation has 8 rows; allowed: 9, one for each grain");
  refused([](Specimen& s) { s.shape = Shape::disc; }, "else none");
  refused([](Specimen& s) { s.contact.slip = Slip::full_radius; }, "allowed for ellipses: \"consistent\"");
}
