// Hertz's law with the radius of curvature of ellipses at the contact (contact/hertz_curvature.hpp): forces and
// stiffnesses of any two, of tips and flanks, what a closed path of such springs gives, and where it is refused.
#include <algorithm>
#include <functional>
#include <random>

#include "rvelab/error.hpp"
#include "tests/bodies.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

using Real = long double;

struct Form {
  Real a, b, angle;
};

/// h, h' and the radius of curvature where the normal points at `normal`, by their definitions.
struct Support {
  Real h, turned, radius;
};
Support support_of(const Form& e, Real normal) {
  const Real c = e.a * std::cos(normal - e.angle), s = e.b * std::sin(normal - e.angle), h = std::sqrt(c * c + s * s);
  return {h, (e.b * e.b - e.a * e.a) * std::cos(normal - e.angle) * std::sin(normal - e.angle) / h,
          e.a * e.a * e.b * e.b / (h * h * h)};
}

/// Branch at which i and j overlap by `overlap` along the normal, and by more along those beside it.
struct Place {
  Real x, y;
};
Place place_at(const Form& i, const Form& j, Real normal, Real overlap) {
  const Support of_i = support_of(i, normal), of_j = support_of(j, normal);
  const Real along = of_i.h + of_j.h - overlap, across = of_i.turned + of_j.turned;
  return {along * std::cos(normal) - across * std::sin(normal), along * std::sin(normal) + across * std::cos(normal)};
}

Real reduced_radius(const Form& i, const Form& j, Real normal) {
  const Real ri = support_of(i, normal).radius, rj = support_of(j, normal).radius;
  return ri * rj / (ri + rj);
}

Material material(double friction = 0) {
  Material m;
  m.young_modulus = 5e7;
  m.poisson_ratio = 0.2;
  m.friction = friction;
  return m;
}
const Real compressive = 5e7L / (2 * (1 - 0.2L * 0.2L)), shear = 5e7L / (4 * (2 - 0.2L) * (1 + 0.2L));  // E*, G*

Specimen two(const Form& i, const Form& j, const Place& at, HertzRadius radius, const Material& m = material()) {
  Specimen s = empty_specimen(Shape::ellipse, 12, m, Law::hertz_mindlin);
  s.contact.hertz_radius = radius;
  s.solver.max_overlap_ratio = 2;
  add_ellipse(s, {0, 0, 0}, double(i.a), double(i.b), double(i.angle));
  add_ellipse(s, {double(at.x), double(at.y), 0}, double(j.a), double(j.b), double(j.angle));
  return s;
}

/// The one contact of two ellipses.
ContactState contact_of(const Specimen& s) {
  const Network n = Rve(s).network();
  REQUIRE(n.contacts.size() == 1);
  return n.contacts[0];
}

double relative(double found, Real expected) { return double(std::abs(Real(found) / expected - 1)); }

/// What springs do to j, N and N m, at a place.
struct Springs {
  Vector3 force;
  double torque, about_i;
};
Springs springs_at(const Specimen& s) {
  const Network n = Rve(s).network();
  return {n.grains[1].resultant, n.grains[1].torque[2], n.grains[0].torque[2]};
}

/// d/ds of a smooth function to 1e-14, by differences of the sixth order.
Real slope_of(const std::function<Real(Real)>& f, Real s) {
  const Real e = 2e-3L;
  return (45 * (f(s + e) - f(s - e)) - 9 * (f(s + 2 * e) - f(s - 2 * e)) + (f(s + 3 * e) - f(s - 3 * e))) / (60 * e);
}

/// A closed path of j about i at rest: overlap, direction of the contact and turn of j as functions of s, 0 to 2 pi.
struct Loop {
  Form i{0.25L, 0.1L, 0.3L}, j{0.2L, 0.12L, 0};
  Real overlap(Real s) const { return 2e-3L * (1 + 0.6L * std::cos(s)); }
  Real normal(Real s) const { return 0.4L + 0.3L * std::sin(2 * s); }
  Form turned(Real s) const { return {j.a, j.b, 1.1L + 0.8L * std::sin(s)}; }
  Place place(Real s) const { return place_at(i, turned(s), normal(s), overlap(s)); }

  /// Work of the springs over the loop, J: the trapezoidal rule, whose error falls as a power of e for what is smooth.
  double work(HertzRadius radius) const {
    constexpr int points = 96;
    Real sum = 0;
    for (int k = 0; k < points; ++k) {
      const Real s = 2 * 3.14159265358979323846L * k / points;
      const Springs f = springs_at(two(i, turned(s), place(s), radius));
      sum += f.force[0] * slope_of([&](Real q) { return place(q).x; }, s) +
             f.force[1] * slope_of([&](Real q) { return place(q).y; }, s) +
             f.torque * slope_of([&](Real q) { return turned(q).angle; }, s);
    }
    return double(sum * 2 * 3.14159265358979323846L / points);
  }
  /// int (f delta/5) (dR*/R*) over the loop: from d(2/5 f delta) = f d(delta) + f delta/5 dR*/R*.
  double unaccounted() const {
    constexpr int points = 96;
    Real sum = 0;
    for (int k = 0; k < points; ++k) {
      const Real s = 2 * 3.14159265358979323846L * k / points, d = overlap(s);
      const auto radius = [&](Real q) { return reduced_radius(i, turned(q), normal(q)); };
      const Real force = 4 * compressive / 3 * std::sqrt(radius(s) * d) * d;
      sum += force * d / 5 * slope_of([&](Real q) { return std::log(radius(q)); }, s);
    }
    return double(sum * 2 * 3.14159265358979323846L / points);
  }
  double scale() const {
    const Real d = overlap(0);
    return double(0.4L * 4 * compressive / 3 * std::sqrt(reduced_radius(i, turned(0), normal(0)) * d) * d * d);
  }
};

}  // namespace

TEST_CASE("Any two ellipses press and stick as Hertz and Mindlin say, with the radii of their curvature") {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0;
  for (int k = 0; k < 400; ++k) {
    const auto ellipse = [&] {
      const double a = 1 + uniform(generator);
      return Form{a, a * std::pow(10, -uniform(generator)), 2 * pi * uniform(generator)};
    };
    const Form i = ellipse(), j = ellipse();
    const Real wanted = 2 * pi * uniform(generator);
    const Real least = std::min(i.b * i.b / i.a, j.b * j.b / j.a);
    const Place rounded = place_at(i, j, wanted, least * (0.05 + 0.5 * uniform(generator)));
    const Place at = {double(rounded.x), double(rounded.y)};
    // What lies there is rounded: Newton's method to the normal and overlap of these numbers.
    Real normal = wanted, overlap = 0;
    const Form di = {double(i.a), double(i.b), double(i.angle)}, dj = {double(j.a), double(j.b), double(j.angle)};
    for (int step = 0; step < 4; ++step) {
      const Support of_i = support_of(di, normal), of_j = support_of(dj, normal);
      const Real x = at.x * std::cos(normal) + at.y * std::sin(normal),
                 y = at.y * std::cos(normal) - at.x * std::sin(normal);
      overlap = of_i.h + of_j.h - x;
      normal -= (of_i.turned + of_j.turned - y) / (of_i.radius + of_j.radius - overlap);
    }
    const Real radius = reduced_radius(di, dj, normal), root = std::sqrt(radius * overlap);
    const ContactState c = contact_of(two(i, j, at, HertzRadius::curvature));
    // The kernel is content with a normal that is right to 1e-10: R grows by 3 |h'/h| of that.
    const Support of_i = support_of(di, normal), of_j = support_of(dj, normal);
    const double allowed = 1e-10 * 3 * double(std::abs(of_i.turned / of_i.h) + std::abs(of_j.turned / of_j.h)) +
                           1e-14 * double((i.a + j.a) / overlap) + 1e-13;
    CAPTURE(k, allowed);
    CHECK(relative(c.normal_force, 4 * compressive / 3 * root * overlap) < allowed);
    CHECK(relative(c.normal_stiffness, 2 * compressive * root) < allowed);
    CHECK(relative(c.tangential_stiffness, 8 * shear * root) < allowed);
    CHECK(relative(c.elastic_energy, 8 * compressive / 15 * root * overlap * overlap) < allowed);
    worst = std::max(worst, relative(c.normal_force, 4 * compressive / 3 * root * overlap));
  }
  INFO(worst);
  CHECK(worst < 1e-9);
}

TEST_CASE("Tip to tip, flank to flank and tip to flank: R of b^2/a and a^2/b") {
  const double a = 0.25, b = GENERATE(0.25, 0.15, 0.05), overlap = 1e-4;
  struct Case {
    double turn_i, turn_j, radius_i, radius_j;
  };
  const double tip = b * b / a, flank = a * a / b;
  for (const Case& meeting : {Case{0, 0, tip, tip}, Case{pi / 2, pi / 2, flank, flank}, Case{0, pi / 2, tip, flank}}) {
    const double reach = (meeting.turn_i == 0 ? a : b) + (meeting.turn_j == 0 ? a : b) - overlap;
    const Form i{a, b, meeting.turn_i}, j{a, b, meeting.turn_j};
    const double radius = 1 / (1 / meeting.radius_i + 1 / meeting.radius_j);
    Material m = material(1e6);
    m.rolling_stiffness = 0.5;
    m.rolling_friction = 1e6;
    m.density = 1e30;  // so heavy that the motion is as prescribed
    Specimen s = two(i, j, {reach, 0}, HertzRadius::curvature, m);
    s.contact.rolling = true;
    s.solver.fixed_time_step = 1e-3;
    CAPTURE(b, meeting.radius_i, meeting.radius_j);
    const double force = double(4 * compressive / 3) * std::sqrt(radius) * std::pow(overlap, 1.5);
    CHECK(contact_of(s).normal_force == Approx(force).epsilon(1e-10));
    // Turned by 1e-8, a slip of (h_i - overlap/2) w_i + (h_j - overlap/2) w_j.
    Rve rve(s);
    const double wi = 1e-8, wj = 3e-8;
    rve.set_velocities({Vector3::Zero(), Vector3::Zero()}, {Vector3(0, 0, wi), Vector3(0, 0, wj)});
    for (int k = 0; k < 10; ++k) rve.apply(Matrix3::Zero(), 0.1);
    const Network n = rve.network();
    REQUIRE(n.contacts.size() == 1);
    const double kt = double(8 * shear) * std::sqrt(radius * overlap);
    const double arm_i = (meeting.turn_i == 0 ? a : b) - overlap / 2,
                 arm_j = (meeting.turn_j == 0 ? a : b) - overlap / 2;
    CHECK(n.contacts[0].tangential_force.y() == Approx(kt * (arm_i * wi + arm_j * wj)).epsilon(1e-5));
    CHECK(n.contacts[0].rolling_moment.z() == Approx(-kt * (a * b) * 0.5 * (wj - wi)).epsilon(1e-5));
  }
}

TEST_CASE("A dashpot of Hertz ellipses is that of the stiffness with the radius of curvature") {
  const double a = 0.25, b = 0.1, overlap = 1e-4, tip = b * b / a;
  Material m = material();
  Specimen s = two({a, b, 0}, {a, b, 0}, {2 * a - overlap, 0}, HertzRadius::curvature, m);
  const double mass = 2650 * pi * a * b / 2, k = double(4 * compressive / 3) * std::sqrt(tip / 2), speed = 0.3;
  s.solver.fixed_time_step = 1e-9;
  s.damping.restitution = 0.6;
  s.damping.normal_coefficient = 40;
  for (const Dashpot dashpot : {Dashpot::restitution, Dashpot::viscoelastic}) {
    s.damping.dashpot = dashpot;
    Rve rve(s);
    rve.set_velocities({Vector3(-speed / 2, 0, 0), Vector3(speed / 2, 0, 0)}, {Vector3::Zero(), Vector3::Zero()});
    const double logarithm = std::log(0.6), zeta = -logarithm / std::sqrt(pi * pi + logarithm * logarithm);
    const double c = dashpot == Dashpot::restitution
                         ? std::sqrt(5.0) * zeta * std::sqrt(mass * k) * std::pow(overlap, 0.25)
                         : 40 * std::sqrt(tip / 2 * overlap) * mass;
    const double expected = k * std::pow(overlap, 1.5) - c * speed;
    CHECK(rve.network().contacts.at(0).normal_force == Approx(expected).epsilon(1e-9));
  }
}

TEST_CASE("Round a closed path Hertz springs of equivalent radius give no work, those of the curvature do") {
  const Loop loop;
  // A normal that is right to 1e-10 leaves that of force times path.
  const double none = loop.work(HertzRadius::equivalent);
  INFO(none << " J");
  CHECK(std::abs(none) < 1e-8 * loop.scale());
  const double gained = loop.work(HertzRadius::curvature);
  INFO(gained << " J, elastic energy up to " << loop.scale() << " J");
  CHECK(std::abs(gained) > 1e-2 * loop.scale());
  CHECK(gained == Approx(loop.unaccounted()).epsilon(1e-8));
}

TEST_CASE("Pressed flank to flank, turned at the same overlap and parted tip to tip: work of 2/5 (f2 - f1) overlap") {
  const Form lying{0.25L, 0.1L, 0};
  const Real overlap = 1e-3L, half_turn = 3.14159265358979323846L / 2;
  const auto at = [&](Real angle, Real depth, HertzRadius radius) {
    const Form i{lying.a, lying.b, angle}, j = i;
    return two(i, j, place_at(i, j, half_turn, depth), radius);
  };
  for (const HertzRadius radius : {HertzRadius::equivalent, HertzRadius::curvature}) {
    // Pressing and parting with u = sqrt(overlap), f d(overlap) = 2 f u du: Simpson's rule.
    const auto pressing = [&](Real angle) {
      constexpr int parts = 40;
      const Real to = std::sqrt(overlap);
      Real sum = 0;
      for (int k = 1; k <= parts; ++k) {
        const Real u = to * k / parts;
        const double force = contact_of(at(angle, u * u, radius)).normal_force;
        sum += (k == parts ? 1 : k % 2 == 1 ? 4 : 2) * 2 * u * force;
      }
      return double(sum * to / parts / 3);
    };
    // While both turn at one overlap, the forces do none.
    double turning = 0;
    for (int k = 0; k <= 20; ++k) {
      const Real angle = half_turn * k / 20;
      const auto place = [&](Real q) {
        const Form e{lying.a, lying.b, q};
        return place_at(e, e, half_turn, overlap);
      };
      const Springs f = springs_at(at(angle, overlap, radius));
      const double power = f.force[0] * double(slope_of([&](Real q) { return place(q).x; }, angle)) +
                           f.force[1] * double(slope_of([&](Real q) { return place(q).y; }, angle)) + f.torque +
                           f.about_i;
      turning = std::max(turning, std::abs(power) / (f.force.norm() * double(lying.a)));
    }
    CHECK(turning < 1e-9);
    const double flanks = contact_of(at(0, overlap, radius)).normal_force,
                 tips = contact_of(at(half_turn, overlap, radius)).normal_force;
    const double gained = pressing(half_turn) - pressing(0), expected = 0.4 * (tips - flanks) * double(overlap);
    CHECK(gained == Approx(expected).epsilon(1e-5).margin(1e-9 * tips * double(overlap)));
    if (radius == HertzRadius::curvature)
      CHECK(flanks / tips == Approx(std::pow(2.5, 1.5)).epsilon(1e-9));  // sqrt of (a^2/b)/(b^2/a)
    else
      CHECK(flanks == Approx(tips).epsilon(1e-11));
  }
}

TEST_CASE("Flanks of spheroids that lie crossed press as Hertz says of both curvatures") {
  const double a = 0.013, b = 0.008, overlap = 2e-5;
  Material m = body_material();
  Specimen s = empty_specimen(Shape::superellipsoid, 0.2, m, Law::hertz_mindlin);
  s.contact.hertz_radius = HertzRadius::curvature;
  add_superellipsoid(s, {b, b, a, 2, 2}, {0, 0, 0}, Turn{});
  add_superellipsoid(s, {b, b, a, 2, 2}, {2 * b - overlap, 0, 0}, cayley_turn({2, 0, 0}));  // by 90 degrees about x
  const Network network = Rve(s).network();
  REQUIRE(network.contacts.size() == 1);
  const double radius = 1 / (1 / b + b / (a * a)), compliance = 2 * (1 - m.poisson_ratio * m.poisson_ratio),
               shear = 4 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio), root = std::sqrt(radius * overlap);
  const ContactState& c = network.contacts[0];
  CHECK(c.overlap == Approx(overlap).epsilon(1e-9));
  CHECK(c.normal_force == Approx(4.0 / 3 * m.young_modulus / compliance * root * overlap).epsilon(1e-9));
  CHECK(c.normal_stiffness == Approx(2 * m.young_modulus / compliance * root).epsilon(1e-9));
  CHECK(c.tangential_stiffness == Approx(8 * m.young_modulus / shear * root).epsilon(1e-9));
}

TEST_CASE("Hertz's radius from curvature is refused where there is none, by name") {
  const auto refused = [](Specimen s, const std::string& text) {
    s.contact.hertz_radius = HertzRadius::curvature;
    CHECK_THROWS_WITH(Rve(s), Catch::Contains("hertz_radius = \"curvature\"") && Catch::Contains(text) &&
                                  Catch::Contains("\"equivalent\""));
  };
  Material m = material();
  m.normal_stiffness = m.tangential_stiffness = 1e6;
  m.stiffness_ratio = 0.5;
  refused(disordered(Shape::disc, 3, m, Law::hertz_mindlin, 0.45, 1), "discs");
  refused(disordered(Shape::sphere, 3, m, Law::hertz_mindlin, 0.45, 1), "spheres");
  for (const Law law : {Law::linear, Law::linear_stiffness, Law::hertz_stiffness, Law::linear_adhesive})
    refused(disordered(Shape::ellipse, 3, m, law, 0.45, 1), "allowed: hertz_mindlin");
}
