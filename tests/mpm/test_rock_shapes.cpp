// Spheres and superquadrics: closed forms, support, distance and gap. Everything is held to the equation of the surface
// itself, written down here, or to brute force.
#include "tests/catch.hpp"
#include "tests/mpm/rock_pairs.hpp"
#include "tools/mpm/shapes/superquadric.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

constexpr double exponents[3][2] = {{2, 2}, {4, 3}, {20, 20}};

/// Below 1 inside, homogeneous of degree 1.
double level(const Vec<3>& half, double n1, double n2, const Vec<3>& x) {
  const Vec<3> p = x.cwiseAbs().cwiseQuotient(half);
  return std::pow(std::pow(std::pow(p[0], n2) + std::pow(p[1], n2), n1 / n2) + std::pow(p[2], n1), 1 / n1);
}
double level(const Vec<2>& half, double n1, double, const Vec<2>& x) {
  const Vec<2> p = x.cwiseAbs().cwiseQuotient(half);
  return std::pow(std::pow(p[0], n1) + std::pow(p[1], n1), 1 / n1);
}

/// The integral from 0 to 1 by tanh and sinh, which powers at the ends do not spoil.
template <class Function>
double integral(const Function& function) {
  double sum = 0;
  const double step = 0.02;
  for (int k = -170; k <= 170; ++k) {
    const double t = step * k, u = 0.5 * std::numbers::pi * std::sinh(t);
    const double x = 1 / (1 + std::exp(-2 * u));
    sum += step * 0.5 * std::numbers::pi * std::cosh(t) / std::pow(std::cosh(u), 2) * 0.5 * function(x);
  }
  return sum;
}
double rest(double x, double n) { return std::pow(1 - std::pow(x, n), 1 / n); }

/// Half axes (m), exponents and the shape.
template <int D>
struct Sample {
  Vec<D> half;
  double n1, n2;
  RockShape<D> shape;
  Sample(Draw& draw, double least, double most)
      : half(half_axes(draw)),
        n1(draw.between(least, most)),
        n2(draw.between(least, most)),
        shape(RockShape<D>::superquadric(half, n1, n2)) {}
  static Vec<D> half_axes(Draw& draw) {
    Vec<D> half;
    for (int i = 0; i < D; ++i) half[i] = draw.between(0.3, 1.5);
    return half;
  }
  double at(const Vec<D>& x) const { return level(half, n1, n2, x); }
};

}  // namespace

TEST_CASE("volume and inertia of superquadrics are integrals over their interior") {
  const double a = 0.7, b = 1.3, c = 0.4;
  for (const auto& [n1, n2] : exponents) {
    const auto plane = RockShape<2>::superquadric({a, b}, n2, 0);
    const double area = 4 * a * b * integral([n = n2](double x) { return rest(x, n); });
    // of x^2 over the plane figure of half axes 1
    const double second = 4 * integral([n = n2](double x) { return x * x * rest(x, n); });
    CHECK(plane.volume() == Approx(area).epsilon(1e-9));
    CHECK(plane.inertia()[0] == Approx(a * b * (a * a + b * b) * second).epsilon(1e-9));
    const auto block = RockShape<3>::superquadric({a, b, c}, n1, n2);
    const auto layers = [n = n1](int power, int moment) {  // s^power z^moment over the height
      return 2 * integral([&](double z) { return std::pow(rest(z, n), power) * std::pow(z, moment); });
    };
    const double across = a * b * c * second * layers(4, 0), along = area * c * c * c * layers(2, 2);
    CHECK(block.volume() == Approx(area * c * layers(2, 0)).epsilon(1e-9));
    CHECK(block.inertia()[0] == Approx(b * b * across + along).epsilon(1e-9));
    CHECK(block.inertia()[1] == Approx(a * a * across + along).epsilon(1e-9));
    CHECK(block.inertia()[2] == Approx((a * a + b * b) * across).epsilon(1e-9));
  }
}

TEST_CASE("with exponents of 2 a superquadric is the ellipsoid, with equal half axes the sphere") {
  const double a = 0.7, b = 1.3, c = 0.4, pi = std::numbers::pi;
  const auto ellipsoid = RockShape<3>::superquadric({a, b, c}, 2, 2);
  CHECK(ellipsoid.volume() == Approx(4 * pi / 3 * a * b * c).epsilon(1e-13));
  CHECK(ellipsoid.inertia()[2] == Approx(ellipsoid.volume() / 5 * (a * a + b * b)).epsilon(1e-13));
  CHECK(ellipsoid.bounding_radius() == b);
  CHECK(ellipsoid.inner_radius() == c);
  const auto ball = RockShape<3>::superquadric({a, a, a}, 2, 2), sphere = RockShape<3>::sphere(a);
  CHECK(sphere.is_sphere());
  CHECK(!ball.is_sphere());
  CHECK(ball.volume() == Approx(sphere.volume()).epsilon(1e-14));
  CHECK((ball.inertia() - sphere.inertia()).norm() < 1e-14);
  CHECK(sphere.equivalent_radius() == Approx(a).epsilon(1e-15));
  const auto disc = RockShape<2>::sphere(a), round = RockShape<2>::superquadric({a, a}, 2, 0);
  CHECK(round.volume() == Approx(disc.volume()).epsilon(1e-14));
  CHECK(round.inertia()[0] == Approx(disc.inertia()[0]).epsilon(1e-14));
  CHECK(disc.inertia()[0] == Approx(0.5 * pi * std::pow(a, 4)).epsilon(1e-15));
  Draw draw;
  for (int k = 0; k < 20; ++k) {
    const Vec<3> r = draw.between(0.1, 2) * draw.direction<3>();
    Vec<3> n, m;
    CHECK(ball.distance(r, n) == Approx(sphere.distance(r, m)).margin(1e-14));
    CHECK((n - m).norm() < 1e-13);
    const Placed<3> here{&ball, r, draw.orientation<3>()}, there{&ball, {2, 0, 0}, draw.orientation<3>()};
    const Gap<3> gap = gap_between(here, there);
    const Gap<3> exact = gap_between<3>({&sphere, r, here.orientation}, {&sphere, {2, 0, 0}, there.orientation});
    CHECK(gap.gap == Approx(exact.gap).margin(1e-13));
    CHECK((gap.normal - exact.normal).norm() < 1e-12);
    CHECK((gap.place - exact.place).norm() < 1e-12);
  }
}

TEMPLATE_TEST_CASE_SIG("the support point lies on the surface, has that normal, and is the gradient of the height", "",
                       ((int D), D), 2, 3) {
  Draw draw;
  for (int k = 0; k < 60; ++k) {
    const Sample<D> sample(draw, 2, k % 2 ? 6 : 50);
    const Vec<D> n = draw.direction<D>(), x = sample.shape.support(n);
    CHECK(sample.at(x) == Approx(1).epsilon(1e-13));
    CHECK(sample.shape.height(n) == Approx(n.dot(x)).epsilon(1e-13));
    CHECK(x.norm() <= sample.shape.bounding_radius() * (1 + 1e-13));
    CHECK(x.norm() >= sample.shape.inner_radius() * (1 - 1e-13));
    for (int other = 0; other < 20; ++other) {  // no point of the surface is farther along n
      const Vec<D> u = draw.direction<D>();
      CHECK(n.dot(u) / sample.at(u) <= n.dot(x) + 1e-13);
    }
    if (k % 2 == 0) continue;
    for (int i = 0; i < D; ++i) {
      if (std::abs(n[i]) < 0.01) continue;
      const double step = 1e-6 * std::abs(n[i]);
      const Vec<D> up = n + step * Vec<D>::Unit(i), down = n - step * Vec<D>::Unit(i);
      const double slope = (sample.shape.height(up) - sample.shape.height(down)) / (2 * step);
      CHECK(slope == Approx(x[i]).margin(1e-7));
    }
  }
}

TEMPLATE_TEST_CASE_SIG("the bounding ball touches the surface and holds it, the inner ball lies inside and touches it",
                       "", ((int D), D), 2, 3) {
  Draw draw;
  for (int k = 0; k < 12; ++k) {
    const Sample<D> sample(draw, 2, 20);
    const double far = brute_force<D>(draw, 500, [&](const Vec<D>& u) { return 1 / sample.at(u); });
    const double near = -brute_force<D>(draw, 500, [&](const Vec<D>& u) { return -1 / sample.at(u); });
    CHECK(sample.shape.bounding_radius() == Approx(far).epsilon(1e-9));
    CHECK(sample.shape.inner_radius() == Approx(near).epsilon(1e-9));
  }
}

TEST_CASE("the ball that rolls inside a superquadric is no larger than any radius of curvature") {
  Draw draw;
  const Superquadric<3> ellipsoid({0.7, 1.3, 0.4}, 2, 2);
  CHECK(ellipsoid.rolling_radius == Approx(0.8 * 0.4 * 0.4 / 1.3).epsilon(1e-9));
  for (int k = 0; k < 8; ++k) {
    const Sample<3> sample(draw, 2, k % 2 ? 6 : 50);
    const double ball = std::get<1>(sample.shape.form())->rolling_radius;
    // It lies inside and touches: no height of the body is less than that of the ball at any of its points.
    for (int at = 0; at < 40; ++at) {
      const Vec<3> n = draw.direction<3>(), x = sample.shape.support(n), centre = x - ball * n;
      Vec<3> unused;
      CHECK(sample.shape.distance(centre, unused) <= -ball * (1 - 1e-9));
    }
  }
}

TEMPLATE_TEST_CASE_SIG("the foot of a distance lies on the surface along its normal, and no point is nearer", "",
                       ((int D), D), 2, 3) {
  Draw draw;
  for (int k = 0; k < 60; ++k) {
    const Sample<D> sample(draw, 2, k % 3 == 0 ? 50 : 6);
    const Vec<D> u = draw.direction<D>(), r = draw.between(0.3, 2.5) / sample.at(u) * u;
    Vec<D> n;
    const double far = sample.shape.distance(r, n);
    CHECK(n.norm() == Approx(1).epsilon(1e-14));
    CHECK((far > 0) == (sample.at(r) > 1));
    CHECK(sample.at(r - far * n) == Approx(1).epsilon(1e-12));
    const auto nearness = [&](const Vec<D>& v) { return -(r - v / sample.at(v)).norm(); };
    const double nearest = -brute_force<D>(draw, 500, nearness);
    CHECK(std::abs(far) <= nearest + 1e-12);
    CHECK(std::abs(far) >= nearest - 1e-6);
    // The distance is the gap of a point: seen along its normal nothing of the body is beyond the foot.
    CHECK(n.dot(r) - sample.shape.height(n) == Approx(far).margin(1e-11));
    if (sample.n1 > 6 || sample.n2 > 6 || std::abs(far) < 0.01) continue;
    Vec<D> unused, slope;
    for (int i = 0; i < D; ++i) {
      const Vec<D> step = 1e-6 * Vec<D>::Unit(i);
      slope[i] = (sample.shape.distance(r + step, unused) - sample.shape.distance(r - step, unused)) / 2e-6;
    }
    CHECK((slope - n).norm() < 1e-6);
  }
}

TEST_CASE("the distance of the centre, where many feet are nearest, is minus the inner radius each time") {
  for (const auto& [n1, n2] : exponents) {
    const auto shape = RockShape<3>::superquadric({0.7, 0.5, 0.5}, n1, n2);
    Vec<3> n, again;
    CHECK(shape.distance(Vec<3>::Zero(), n) == Approx(-0.5).epsilon(1e-13));
    CHECK(shape.distance(Vec<3>::Zero(), again) == Approx(-0.5).epsilon(1e-13));
    CHECK(n == again);
    CHECK(std::abs(n[0]) < 1e-12);
  }
}

TEMPLATE_TEST_CASE_SIG("the gap is reached along its normal, and no direction of brute force has a larger one", "",
                       ((int D), D), 2, 3) {
  Draw draw;
  const double ranges[3][2] = {{2, 2}, {2, 6}, {20, 50}};
  for (const auto& [least, most] : ranges) {
    for (const double gap : {0.4, 0.01, -0.001, -0.03}) {
      for (int k = 0; k < 5; ++k) {
        const PlacedPair<D> pair(draw, draw.superquadric<D>(least, most), draw.superquadric<D>(least, most), gap);
        const auto a = pair.a(), b = pair.b();
        const Gap<D> found = gap_between(a, b);
        CHECK(found.gap == Approx(gap).margin(1e-6));
        CHECK(found.normal.norm() == Approx(1).epsilon(1e-14));
        CHECK(found.gap == Approx(gap_along<D>(a, b, found.normal)).margin(1e-13));
        const double brute = brute_force<D>(draw, 1500, [&](const Vec<D>& n) { return gap_along<D>(a, b, n); });
        CHECK(found.gap >= brute - 1e-9);
        if (most <= 6) CHECK(found.gap <= brute + 1e-9);  // of blocks brute force is slow to come to the ridge
        const Gap<D> turned = gap_between(b, a);
        CHECK(turned.gap == found.gap);
        CHECK(turned.normal == -found.normal);
        CHECK(turned.place == found.place);
      }
    }
  }
}

TEMPLATE_TEST_CASE_SIG("the gap is a potential: a shift of a rock changes it by the normal, a turn by the arm of place",
                       "", ((int D), D), 2, 3) {
  Draw draw;
  for (int k = 0; k < 30; ++k) {
    const auto second = k % 3 == 0 ? RockShape<D>::sphere(0.6) : draw.superquadric<D>(2, 6);
    const PlacedPair<D> pair(draw, draw.superquadric<D>(2, 6), second, k % 2 ? 0.1 : -0.01);
    const auto a = pair.a(), b = pair.b();
    const Gap<D> found = gap_between(a, b);
    constexpr double step = 1e-6;
    const auto slope = [&](const auto& move) {
      Placed<D> forth = b, back = b;
      move(forth, step);
      move(back, -step);
      return (gap_between(a, forth).gap - gap_between(a, back).gap) / (2 * step);
    };
    for (int i = 0; i < D; ++i) {
      const auto shift = [i](Placed<D>& rock, double by) { rock.centre[i] += by; };
      CHECK(slope(shift) == Approx(found.normal[i]).margin(1e-7));
    }
    const Vec<D> arm = found.place - b.centre, n = found.normal;
    if constexpr (D == 2) {
      const auto turn = [](Placed<D>& rock, double by) { rock.orientation += by; };
      CHECK(slope(turn) == Approx(arm[0] * n[1] - arm[1] * n[0]).margin(1e-7));
    } else {
      for (int i = 0; i < 3; ++i) {
        const auto turn = [i](Placed<D>& rock, double by) {
          rock.orientation = Eigen::AngleAxisd(by, Vec<3>::Unit(i)) * rock.orientation;
        };
        CHECK(slope(turn) == Approx(arm.cross(n)[i]).margin(1e-7));
      }
    }
  }
}

TEMPLATE_TEST_CASE_SIG("a rotation and a translation of both rocks turn the normal with them and leave the gap", "",
                       ((int D), D), 2, 3) {
  Draw draw;
  for (int k = 0; k < 30; ++k) {
    const double most = k % 2 ? 4 : 50;
    const PlacedPair<D> pair(draw, draw.superquadric<D>(2, most), draw.superquadric<D>(2, most), k % 3 ? -0.01 : 0.1);
    Placed<D> a = pair.a(), b = pair.b();
    const Gap<D> before = gap_between(a, b);
    const Rot<D> turn = draw.orientation<D>();
    const Vec<D> shift = draw.direction<D>();
    for (Placed<D>* rock : {&a, &b}) {
      rock->centre = to_world<D>(turn, rock->centre) + shift;
      if constexpr (D == 2) {
        rock->orientation += turn;
      } else {
        rock->orientation = turn * rock->orientation;
      }
    }
    const Gap<D> after = gap_between(a, b);
    CHECK(after.gap == Approx(before.gap).margin(1e-12));
    CHECK((after.normal - to_world<D>(turn, before.normal)).norm() < 1e-12);
    if (most < 5) CHECK((after.place - to_world<D>(turn, before.place) - shift).norm() < 1e-9);
  }
}

TEST_CASE("blocks laid flat on each other touch along the common axis, however little they are tilted") {
  for (const double tilt : {0.0, 1e-9, 1e-5, 1e-2}) {
    const auto low = RockShape<3>::superquadric({1, 0.5, 0.5}, 20, 20);
    const auto high = RockShape<3>::superquadric({0.5, 0.7, 0.3}, 20, 20);
    const Vec<3> axis = Vec<3>(1, 2, 0).normalized();
    const Placed<3> a{&low, Vec<3>::Zero(), Eigen::Quaterniond::Identity()};
    const Placed<3> b{&high, {0.2, -0.1, 0.79}, Eigen::Quaterniond(Eigen::AngleAxisd(tilt, axis))};
    const Gap<3> found = gap_between(a, b);
    Draw draw;
    const double brute = brute_force<3>(draw, 1500, [&](const Vec<3>& n) { return gap_along<3>(a, b, n); });
    CHECK(found.gap >= brute - 1e-12);
    CHECK(found.gap >= gap_along<3>(a, b, {0, 0, 1}) - 1e-15);
    CHECK(found.gap == Approx(-0.01).margin(1e-3 + tilt));
    CHECK(found.normal[2] > std::cos(1e-3 + tilt));
  }
}

TEMPLATE_TEST_CASE_SIG("points of the surface lie on it, and their areas add up to its area", "", ((int D), D), 2, 3) {
  Draw draw;
  for (int k = 0; k < 6; ++k) {
    const Sample<D> sample(draw, k < 2 ? 2 : 10, k < 2 ? 2 : 40);
    const double spacing = sample.shape.inner_radius() / 5;
    double area = 0;
    Vec<D> closed = Vec<D>::Zero();
    long count = 0;
    const auto visit = [&](const Vec<D>& x, const Vec<D>& n, double part) {
      ++count;
      area += part;
      closed += part * n;
      if (count % 7) return;
      CHECK(sample.at(x) == Approx(1).epsilon(1e-12));
      CHECK(n.dot(x) == Approx(sample.shape.height(n)).epsilon(1e-9));
    };
    sample.shape.each_surface_point(spacing, visit);
    double finer = 0, cones = 0;  // by the divergence of x the cones from the centre to the patches fill the body
    sample.shape.each_surface_point(spacing / 8, [&](const Vec<D>& x, const Vec<D>& n, double part) {
      finer += part;
      cones += part * n.dot(x) / D;
    });
    CHECK(area == Approx(finer).epsilon(0.002));
    CHECK(cones == Approx(sample.shape.volume()).epsilon(0.002));
    CHECK(closed.norm() < 1e-9 * area);
    const double each = area / double(count);
    CHECK(each == Approx(std::pow(spacing, D - 1)).epsilon(0.35));
  }
  const auto sphere = RockShape<D>::sphere(0.4);
  double area = 0;
  sphere.each_surface_point(0.05, [&](const Vec<D>& x, const Vec<D>& n, double part) {
    CHECK((x - 0.4 * n).norm() < 1e-15);
    area += part;
  });
  CHECK(area == Approx(std::numbers::pi * (D == 2 ? 0.8 : 0.64)).epsilon(1e-12));
}

TEST_CASE("shapes out of range are refused in words") {
  CHECK_THROWS_WITH(RockShape<3>::sphere(0), Catch::Matchers::Contains("radius is 0 m; it must be positive"));
  CHECK_THROWS_AS(RockShape<3>::sphere(std::nan("")), InputError);
  CHECK_THROWS_WITH(RockShape<3>::superquadric({1, -1, 1}, 4, 4), Catch::Matchers::Contains("half axis is -1 m"));
  CHECK_THROWS_WITH(RockShape<3>::superquadric({1, 1, 1}, 1.5, 4), Catch::Matchers::Contains("1.5"));
  CHECK_THROWS_WITH(RockShape<3>::superquadric({1, 1, 1}, 4, 51), Catch::Matchers::Contains("between 2"));
  CHECK_NOTHROW(RockShape<2>::superquadric({1, 1}, 4, 0));  // the second exponent is ignored in the plane
}
