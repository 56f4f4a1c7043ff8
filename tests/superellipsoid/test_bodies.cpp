// One superellipsoid: support, curvature and mass against the equation of its surface, quadrature and closed forms.
#include "tests/catch.hpp"
#include "tests/superellipsoid/random_pairs.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// The integral from 0 to 1 by tanh and sinh, which powers at the ends do not spoil.
template <class Function>
double integral(const Function& function) {
  double sum = 0;
  const double step = 0.02;
  for (int k = -170; k <= 170; ++k) {
    const double u = 0.5 * std::numbers::pi * std::sinh(step * k);
    const double weight = 0.5 * std::numbers::pi * std::cosh(step * k) / std::pow(std::cosh(u), 2) * 0.5;
    sum += step * weight * function(1 / (1 + std::exp(-2 * u)));
  }
  return sum;
}
double rest(double x, double n) { return std::pow(1 - std::pow(x, n), 1 / n); }

}  // namespace

TEST_CASE("powers agree with those of libm to rounding") {
  Draw draw;
  for (int k = 0; k < 20000; ++k) {
    const double x = std::pow(2, -draw.between(0, k % 2 ? 1 : 900)), y = draw.between(0, 1.1);
    CHECK(std::abs(power_of(x, y) - std::pow(x, y)) < 4e-16);
    CHECK(power_of(1 + x, -y) == Approx(std::pow(1 + x, -y)).epsilon(1e-15));
  }
  CHECK(power_of(1.0, 0.3) == 1);
}

TEST_CASE("a support point lies on the surface, no other point is farther, and the surface there is normal to it") {
  Draw draw;
  for (int k = 0; k < 200; ++k) {
    const Superellipsoid s = draw.shape(k % 2 ? 8 : 50, 10);
    const Vector n = draw.direction();
    const SupportAt<double> at = support_at(plain_form_of(s), own_axes, n);
    const Vector x = at.point;
    CHECK(gauge_of(s, x.x, x.y, x.z) == Approx(1).epsilon(1e-13));
    CHECK(at.height == Approx(dot(n, x)).epsilon(1e-13));
    CHECK(length_of(x) <= bounding_radius_of(s) * (1 + 1e-13));
    CHECK(length_of(x) >= inner_radius_of(s) * (1 - 1e-13));
    for (int other = 0; other < 30; ++other) {
      const Vector u = draw.direction();
      CHECK(dot(n, u) / gauge_of(s, u.x, u.y, u.z) <= at.height * (1 + 1e-13));
    }
    const Vector back = normal_at(plain_form_of(s), own_axes, x);
    if (s.e < 8 && s.n < 8) CHECK(length_of(difference(back, n)) < 1e-9);
  }
}

TEST_CASE("the modes are how support points move with the direction") {
  Draw draw;
  for (int k = 0; k < 100; ++k) {
    CAPTURE(k);
    const Superellipsoid s = draw.shape(6, 3);
    const SuperellipsoidForm<double> form = plain_form_of(s);
    const Axes axes = draw.axes();
    const Vector n = draw.direction(), t = of_length_1(cross(n, draw.direction()));
    const Vector own = in_frame(axes, n);
    if (std::min({std::abs(own.x), std::abs(own.y), std::abs(own.z)}) < 0.05) continue;
    const SupportAt<double> at = support_at(form, axes, n);
    constexpr double step = 1e-5;
    const Vector ahead = support_at(form, axes, plus(n, step, t)).point,
                 behind = support_at(form, axes, plus(n, -step, t)).point;
    const Vector moves = times(0.5 / step, difference(ahead, behind));
    Vector by_modes = times(at.xy.stiffness * dot(at.xy.along, t), at.xy.along);
    by_modes = plus(by_modes, at.z.stiffness * dot(at.z.along, t), at.z.along);
    CHECK(length_of(difference(moves, by_modes)) < 1e-5 * (1 + length_of(moves)));
  }
}

TEST_CASE("radii of curvature of an ellipsoid: their product is (abc)^2/h^4, their sum follows from h = sqrt(n.M n)") {
  Draw draw;
  for (int k = 0; k < 100; ++k) {
    const Superellipsoid s = {draw.between(0.2, 1), draw.between(0.2, 1), draw.between(0.2, 1), 2, 2};
    const Vector n = draw.direction();
    const RadiiOfCurvature<double> radii = radii_of_curvature(support_at(plain_form_of(s), own_axes, n));
    const Vector Mn = {s.a * s.a * n.x, s.b * s.b * n.y, s.c * s.c * n.z};
    const double h = std::sqrt(dot(n, Mn)), trace = s.a * s.a + s.b * s.b + s.c * s.c;
    CHECK(radii.product == Approx(std::pow(s.a * s.b * s.c, 2) / std::pow(h, 4)).epsilon(1e-12));
    CHECK(radii.sum == Approx((trace - dot(Mn, Mn) / (h * h)) / h).epsilon(1e-12));
  }
}

TEST_CASE("volume and inertia are integrals over the interior") {
  const double a = 0.7, b = 1.3, c = 0.4;
  for (const auto& [n, e] : {std::pair{2.0, 2.0}, {4.0, 3.0}, {8.0, 2.0}, {20.0, 20.0}}) {
    const Superellipsoid s = {a, b, c, e, n};
    const double area = 4 * a * b * integral([e = e](double x) { return rest(x, e); });
    const double second = 4 * integral([e = e](double x) { return x * x * rest(x, e); });
    const auto layers = [n = n](int power, int moment) {
      return 2 * integral([&](double z) { return std::pow(rest(z, n), power) * std::pow(z, moment); });
    };
    const double across = a * b * c * second * layers(4, 0), along = area * c * c * c * layers(2, 2);
    CHECK(superellipse_area(a, b, e) == Approx(area).epsilon(1e-9));
    CHECK(superellipse_inertia(a, b, e) == Approx(a * b * (a * a + b * b) * second).epsilon(1e-9));
    CHECK(volume_of(s) == Approx(area * c * layers(2, 0)).epsilon(1e-9));
    CHECK(inertia_of(s).x == Approx(b * b * across + along).epsilon(1e-9));
    CHECK(inertia_of(s).y == Approx(a * a * across + along).epsilon(1e-9));
    CHECK(inertia_of(s).z == Approx((a * a + b * b) * across).epsilon(1e-9));
  }
  CHECK(equivalent_radius_of({0.5, 1, 2, 2, 2}) == Approx(1).epsilon(1e-14));
  CHECK(aspect_of({0.5, 1, 2, 4, 8}) == 0.25);
}

TEST_CASE("surface and sphericity: spheres, spheroids, boxes") {
  const double pi = std::numbers::pi;
  CHECK(surface_of({0.3, 0.3, 0.3, 2, 2}) == Approx(4 * pi * 0.09).epsilon(1e-12));
  CHECK(sphericity_of({0.3, 0.3, 0.3, 2, 2}) == Approx(1).epsilon(1e-12));
  const double a = 0.4, c = 1, e = std::sqrt(1 - a * a / (c * c));
  CHECK(surface_of({a, a, c, 2, 2}) == Approx(2 * pi * a * a * (1 + c / (a * e) * std::asin(e))).epsilon(1e-10));
  CHECK(surface_of({a, c, a, 2, 2}) == Approx(surface_of({a, a, c, 2, 2})).epsilon(1e-10));
  // Of a cube (pi/6)^(1/3); rounded edges make a body rounder.
  const double cube = std::cbrt(pi / 6);
  CHECK(sphericity_of({1, 1, 1, 50, 50}) == Approx(cube).epsilon(0.03));
  CHECK(sphericity_of({1, 1, 1, 8, 8}) > sphericity_of({1, 1, 1, 20, 20}));
  CHECK(sphericity_of({1, 1, 1, 4, 4}) > sphericity_of({1, 1, 1, 8, 8}));
  CHECK(sphericity_of({1, 1, 1, 20, 20}) > cube);
}

TEST_CASE("a ball of the rolling radius fits into the shape wherever it touches") {
  Draw draw;
  for (int k = 0; k < 40; ++k) {
    const Superellipsoid s = draw.shape(20, 10);
    const double r = rolling_radius_of(s);
    for (int at = 0; at < 20; ++at) {
      const Vector n = draw.direction(), x = support_at(plain_form_of(s), own_axes, n).point, middle = plus(x, -r, n);
      for (int way = 0; way < 20; ++way) {
        const Vector u = draw.direction();
        CHECK(dot(middle, u) + r <= support_at(plain_form_of(s), own_axes, u).height + 1e-12);
      }
    }
  }
}
