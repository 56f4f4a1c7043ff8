// Convex polyhedra as rocks. STL files: tests/grains/test_filling.cpp.
#include "tests/catch.hpp"
#include "tests/mpm/rock_pairs.hpp"

using namespace mpm;
using namespace mpm::test;
using Catch::Matchers::Contains;

namespace {

/// A prism of n sides (4: a box whose sides are sqrt(2)), closed by fans; or with a point on top instead of a lid.
std::vector<Triangle> prism(int n, bool pointed = false) {
  std::vector<Triangle> surface;
  const auto corner = [n](int k, double z) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / n;
    return Vec<3>(std::cos(angle), std::sin(angle), z);
  };
  for (int k = 0; k < n; ++k) {
    surface.push_back({Vec<3>(0, 0, -1), corner(k + 1, -1), corner(k, -1)});
    surface.push_back({corner(k, -1), corner(k + 1, -1), pointed ? Vec<3>(0, 0, 1) : corner(k + 1, 1)});
    if (pointed) continue;
    surface.push_back({corner(k, -1), corner(k + 1, 1), corner(k, 1)});
    surface.push_back({Vec<3>(0, 0, 1), corner(k, 1), corner(k + 1, 1)});
  }
  return surface;
}

std::vector<Triangle> mapped(std::vector<Triangle> surface, const Mat<3>& map, const Vec<3>& shift = Vec<3>::Zero()) {
  for (auto& triangle : surface) {
    for (auto& corner : triangle) corner = (map * corner + shift).eval();
  }
  return surface;
}

std::vector<Triangle> box(const Vec<3>& half) {
  return mapped(prism(4), Vec<3>(half[0] * std::sqrt(2.0), half[1] * std::sqrt(2.0), half[2]).asDiagonal());
}

RockShape<3> shape_of(const std::vector<Triangle>& surface) {
  return RockShape<3>::polyhedron(surface, nullptr, nullptr);
}

/// A prism or a pyramid of few or many sides, sheared at random.
RockShape<3> sheared(Draw& draw) {
  Mat<3> map = Mat<3>::Identity();
  for (int k = 0; k < 9; ++k) map(k) = 0.6 * map(k) + draw.between(-0.2, 0.2);
  return shape_of(mapped(prism(3 + int(draw.between(0, 7)), draw.between(0, 1) < 0.5), map));
}

double box_distance(const Vec<3>& half, const Vec<3>& r) {
  const Vec<3> beyond = r.cwiseAbs() - half;
  return beyond.maxCoeff() <= 0 ? beyond.maxCoeff() : beyond.cwiseMax(0).norm();
}

void check_gap(Draw& draw, const Placed<3>& a, const Placed<3>& b) {
  const Gap<3> found = gap_between(a, b);
  CHECK(found.normal.norm() == Approx(1).epsilon(1e-14));
  CHECK(found.gap == Approx(gap_along<3>(a, b, found.normal)).margin(1e-12));
  const double brute = brute_force<3>(draw, 1500, [&](const Vec<3>& n) { return gap_along<3>(a, b, n); });
  CHECK(found.gap >= brute - 1e-9);
  const Gap<3> turned = gap_between(b, a);
  CHECK(turned.gap == found.gap);
  CHECK(turned.normal == -found.normal);
  CHECK(turned.place == found.place);
}

}  // namespace

TEST_CASE("a box of triangles has the volume, inertia, balls and distance of the box, wherever it was drawn") {
  const Vec<3> half(0.7, 0.4, 1.1), shift(3, -2, 5);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.3, Vec<3>(1, 2, -1).normalized()));
  Vec<3> centre;
  Eigen::Quaterniond orientation;
  auto surface = mapped(box(half), turn.toRotationMatrix(), shift);
  for (const bool inside_out : {false, true}) {
    if (inside_out) {
      for (auto& triangle : surface) std::swap(triangle[0], triangle[1]);
    }
    const auto shape = RockShape<3>::polyhedron(surface, &centre, &orientation);
    CHECK((centre - shift).norm() < 1e-13);
    CHECK(orientation.angularDistance(turn) < 1e-12);
    const double volume = 8 * half.prod();
    CHECK(shape.volume() == Approx(volume).epsilon(1e-13));
    for (int i = 0; i < 3; ++i) {
      const double across = half.squaredNorm() - half[i] * half[i];
      CHECK(shape.inertia()[i] == Approx(volume / 3 * across).epsilon(1e-12));
    }
    CHECK(shape.bounding_radius() == Approx(half.norm()).epsilon(1e-13));
    CHECK(shape.inner_radius() == Approx(half.minCoeff()).epsilon(1e-12));
    Draw draw;
    for (int k = 0; k < 100; ++k) {
      const Vec<3> r = draw.between(0.1, 2.5) * draw.direction<3>();
      Vec<3> n, unused, slope;
      CHECK(shape.distance(r, n) == Approx(box_distance(half, r)).margin(1e-12));
      for (int i = 0; i < 3; ++i) {
        const Vec<3> step = 1e-6 * Vec<3>::Unit(i);
        slope[i] = (shape.distance(r + step, unused) - shape.distance(r - step, unused)) / 2e-6;
      }
      CHECK((slope - n).norm() < 1e-5);
      const Vec<3> direction = draw.direction<3>();
      CHECK(shape.height(direction) == Approx(direction.cwiseAbs().dot(half)).epsilon(1e-12));
      CHECK(shape.support(direction).dot(direction) == Approx(shape.height(direction)).epsilon(1e-14));
    }
  }
}

TEST_CASE("a regular tetrahedron: volume and inertia of the text book, one moment about every axis") {
  const Vec<3> a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);  // edge sqrt(8)
  Vec<3> centre;
  const Vec<3> shift(0.1, 0.2, 0.3);
  const auto surface = mapped({{a, c, b}, {a, b, d}, {a, d, c}, {b, c, d}}, Mat<3>::Identity(), shift);
  const auto shape = RockShape<3>::polyhedron(surface, &centre, nullptr);
  const double edge = std::sqrt(8.0), volume = std::pow(edge, 3) / (6 * std::sqrt(2.0));
  CHECK(shape.volume() == Approx(volume).epsilon(1e-13));
  CHECK((centre - shift).norm() < 1e-14);
  for (int i = 0; i < 3; ++i) CHECK(shape.inertia()[i] == Approx(volume * edge * edge / 20).epsilon(1e-12));
}

TEST_CASE("the gap of two boxes with common axes: the distance apart, the least overlap where they overlap") {
  const Vec<3> half_a(0.7, 0.4, 1.1), half_b(0.3, 0.5, 0.2);
  const auto first = shape_of(box(half_a)), second = shape_of(box(half_b));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.8, Vec<3>(-1, 2, 1).normalized()));
  Draw draw;
  int apart = 0;
  for (int k = 0; k < 200; ++k) {
    const Vec<3> centre_a = draw.direction<3>(), between = draw.between(0.5, 1.7) * draw.direction<3>();
    const Placed<3> a{&first, centre_a, turn}, b{&second, centre_a + turn * between, turn};
    const double exact = box_distance(half_a + half_b, between);
    const Gap<3> found = gap_between(a, b);
    CHECK(found.gap == Approx(exact).margin(1e-12));
    CHECK(found.gap == Approx(gap_along<3>(a, b, found.normal)).margin(1e-12));
    apart += exact > 0;
    if (exact > 0) continue;
    // Along the normal the middle between the two faces, across it that of what both have in common.
    const Vec<3> low = (-half_a).cwiseMax(between - half_b), high = half_a.cwiseMin(between + half_b);
    Vec<3> middle = 0.5 * (low + high);
    const Vec<3> n = turn.conjugate() * found.normal;
    int axis = 0;
    CHECK(n.cwiseAbs().maxCoeff(&axis) == Approx(1).epsilon(1e-12));
    middle[axis] = 0.5 * (n[axis] * (half_a - half_b)[axis] + between[axis]);
    CHECK((found.place - centre_a - turn * middle).norm() < 1e-10);
  }
  CHECK(apart > 50);
  CHECK(apart < 150);
}

TEST_CASE(
    "polyhedra at random: the gap is reached along its normal, and no direction of brute force has a larger one") {
  Draw draw;
  for (const double gap : {0.3, 1e-3, -1e-3, -0.05}) {
    for (int k = 0; k < 8; ++k) {
      const PlacedPair<3> pair(draw, sheared(draw), sheared(draw), gap);
      check_gap(draw, pair.a(), pair.b());
      const PlacedPair<3> other(draw, sheared(draw), draw.superquadric<3>(2, k % 2 ? 4 : 30), gap);
      check_gap(draw, other.a(), other.b());
      const PlacedPair<3> round(draw, sheared(draw), RockShape<3>::sphere(0.5), gap);
      check_gap(draw, round.a(), round.b());
      const auto ball = RockShape<3>::superquadric({0.5, 0.5, 0.5}, 2, 2);
      const Placed<3> in_its_place{&ball, round.place_b, round.turn_b};
      CHECK(gap_between(round.a(), in_its_place).gap == Approx(gap_between(round.a(), round.b()).gap).margin(1e-12));
    }
  }
}

TEST_CASE("the gap of polyhedra is a potential, and does not see a common rotation and translation") {
  Draw draw;
  for (int k = 0; k < 30; ++k) {
    const auto second = k % 2 ? sheared(draw) : draw.superquadric<3>(2, 5);
    const PlacedPair<3> pair(draw, sheared(draw), second, k % 3 ? -0.01 : 0.1);
    const auto a = pair.a(), b = pair.b();
    const Gap<3> found = gap_between(a, b);
    constexpr double step = 1e-7;
    const Vec<3> arm = found.place - b.centre;
    for (int i = 0; i < 3; ++i) {
      Placed<3> forth = b, back = b;
      forth.centre[i] += step;
      back.centre[i] -= step;
      CHECK((gap_between(a, forth).gap - gap_between(a, back).gap) / (2 * step) ==
            Approx(found.normal[i]).margin(1e-5));
      forth.centre = back.centre = b.centre;
      forth.orientation = Eigen::AngleAxisd(step, Vec<3>::Unit(i)) * b.orientation;
      back.orientation = Eigen::AngleAxisd(-step, Vec<3>::Unit(i)) * b.orientation;
      const double slope = (gap_between(a, forth).gap - gap_between(a, back).gap) / (2 * step);
      CHECK(slope == Approx(arm.cross(found.normal)[i]).margin(1e-5));
    }
    const Eigen::Quaterniond turn = draw.orientation<3>();
    const Vec<3> shift = draw.direction<3>();
    const Placed<3> new_a{a.shape, turn * a.centre + shift, turn * a.orientation};
    const Placed<3> new_b{b.shape, turn * b.centre + shift, turn * b.orientation};
    const Gap<3> after = gap_between(new_a, new_b);
    CHECK(after.gap == Approx(found.gap).margin(1e-12));
    CHECK((after.normal - turn * found.normal).norm() < 1e-11);
    CHECK((after.place - turn * found.place - shift).norm() < 1e-9);
  }
}

TEST_CASE("points of a polyhedron's surface: their areas are its area, and they close it") {
  const Vec<3> half(0.7, 0.4, 1.1);
  const auto shape = shape_of(box(half));
  const double spacing = shape.inner_radius() / 5;
  double area = 0, cones = 0;
  long count = 0;
  Vec<3> closed = Vec<3>::Zero();
  shape.each_surface_point(spacing, [&](const Vec<3>& x, const Vec<3>& n, double part) {
    CHECK(box_distance(half, x) == Approx(0).margin(1e-12));
    ++count;
    area += part;
    cones += part * x.dot(n) / 3;
    closed += part * n;
  });
  const double exact = 8 * (half[0] * half[1] + half[1] * half[2] + half[2] * half[0]);
  CHECK(area == Approx(exact).epsilon(1e-12));
  CHECK(cones == Approx(shape.volume()).epsilon(1e-12));
  CHECK(closed.norm() < 1e-12);
  CHECK(exact / double(count) == Approx(spacing * spacing).epsilon(0.5));
}

TEST_CASE("surfaces that are no convex body are refused in words") {
  const auto refused = [](const std::vector<Triangle>& surface, const std::string& words, const std::string& remedy) {
    CHECK_THROWS_WITH(shape_of(surface), Contains(words) && Contains(remedy));
  };
  auto surface = box({1, 1, 1});
  surface.pop_back();
  refused(surface, "not closed", "fill its holes");
  surface = box({1, 1, 1});
  std::swap(surface[5][0], surface[5][1]);
  refused(surface, "turned differently", "make its normals agree");
  refused({}, "0 triangles", "four or more");
  surface = prism(6, true);
  for (auto& triangle : surface) {
    for (auto& corner : triangle) {
      if (corner[2] == 1) corner[2] = -1.5;  // the tip comes out below the base
      if (corner == Vec<3>(0, 0, -1)) corner[2] = -1.8;
    }
  }
  refused(surface, "not convex", "convex hull");
  surface = box({1, 1, 1});
  const auto second = mapped(box({1, 1, 1}), Mat<3>::Identity(), {5, 0, 0});
  surface.insert(surface.end(), second.begin(), second.end());
  refused(surface, "not convex", "convex hull");
  surface = box({1, 1, 1});
  surface[2][1][0] = std::nan("");
  refused(surface, "not finite", "again");
  const Vec<3> a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0);
  refused({{a, b, c}, {a, d, b}, {a, c, d}, {b, d, c}}, "no volume", "");
}
