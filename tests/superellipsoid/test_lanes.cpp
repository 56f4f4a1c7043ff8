// Many pairs at a time: the bits of one pair alone, whatever the width and wherever a search begins; ellipsoids by
// their own formulas; forces and moments.
#include "rvelab/grains/superellipsoid.hpp"
#include "rvelab/superellipsoid/ellipsoids.hpp"
#include "tests/catch.hpp"
#include "tests/superellipsoid/random_pairs.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// W pairs side by side: both are nothing but doubles.
template <int W>
SuperellipsoidPair<typename Lanes<W>::V> side_by_side(const OverlapPair* pairs) {
  constexpr std::size_t members = sizeof(OverlapPair) / sizeof(double);
  SuperellipsoidPair<typename Lanes<W>::V> joined;
  double columns[members][W];
  for (std::size_t m = 0; m < members; ++m)
    for (int lane = 0; lane < W; ++lane)
      std::memcpy(&columns[m][lane], reinterpret_cast<const char*>(&pairs[lane]) + m * sizeof(double), sizeof(double));
  static_assert(sizeof(joined) == sizeof(columns));
  std::memcpy(static_cast<void*>(&joined), columns, sizeof(columns));
  return joined;
}

template <class V>
std::vector<double> numbers_of(const ContactsOf<V>& c, int lane) {
  if (!(in_lane(c.overlap, lane) > 0)) return {0};
  return {in_lane(c.overlap, lane), in_lane(c.n.x, lane),     in_lane(c.n.y, lane),    in_lane(c.n.z, lane),
          in_lane(c.point.x, lane), in_lane(c.point.y, lane), in_lane(c.point.z, lane)};
}

/// Without a guess, or with one near the normal, or anywhere.
template <int W>
std::vector<std::vector<double>> contacts_by(const std::vector<OverlapPair>& pairs, Draw& draw, double spread) {
  using V = typename Lanes<W>::V;
  std::vector<std::vector<double>> all;
  for (std::size_t k = 0; k + W <= pairs.size(); k += W) {
    Triple<V> guess = {V{}, V{}, V{}};
    const auto pair = side_by_side<W>(&pairs[k]);
    ContactsOf<V> contacts = contacts_of(pair, guess);
    if (spread > 0) {
      const Vector u = draw.direction();
      guess = of_length_1(plus(guess, V{} + spread, Triple<V>{V{} + u.x, V{} + u.y, V{} + u.z}));
      contacts = contacts_of(pair, guess);
    }
    for (int lane = 0; lane < W; ++lane) all.push_back(numbers_of(contacts, lane));
  }
  return all;
}

std::vector<OverlapPair> drawn_pairs(Draw& draw, int count, double exponent, double aspect) {
  std::vector<OverlapPair> pairs;
  for (int k = 0; k < count; ++k) {
    pairs.push_back(known_pair(draw, draw.shape(exponent, aspect), draw.shape(exponent, aspect), k % 3, 0.03).pair);
    if (k % 5 == 0) pairs.back().branch = times(1.1, pairs.back().branch);
  }
  return pairs;
}

/// f = k overlap^(3/2); its energy is 2/5 f overlap.
struct Hertz {
  double k = 1e6;
  template <class V>
  V operator()(V overlap) const {
    return k * (overlap * square_root(overlap));
  }
};

/// Force on j of the overlap along n at the contact point, and the moments on both.
struct NormalForces {
  double overlap;
  Vector force, moment_i, moment_j;
};
struct TwoGrains {
  Superellipsoid shape[2];
  Vector at[2];
  Axes axes[2];
  void set(int grain, const Superellipsoid& s, const Vector& x, const Axes& turned) {
    shape[grain] = s;
    at[grain] = x;
    axes[grain] = turned;
  }
  NormalForces forces() const {
    const OverlapPair pair = {form_of(shape[0]), form_of(shape[1]), axes[0], axes[1], difference(at[1], at[0])};
    Triple<double> guess = {0, 0, 0};
    const ContactsOf<double> contact = contacts_of(pair, guess);
    const Vector force = times(Hertz{}(std::max(0.0, contact.overlap)), contact.n),
                 arm_j = difference(contact.point, pair.branch);
    return {contact.overlap, force, cross(force, contact.point), cross(arm_j, force)};
  }
};

}  // namespace

TEST_CASE("contacts have the same bits one, two at a time, and from any guess") {
  Draw draw;
  for (const auto& [exponent, aspect] : {std::pair{4.0, 3.0}, {8.0, 10.0}}) {
    const auto pairs = drawn_pairs(draw, 600, exponent, aspect);
    const auto alone = contacts_by<1>(pairs, draw, 0);
    CHECK(contacts_by<2>(pairs, draw, 0) == alone);
    for (const double spread : {1e-9, 1e-7, 1e-5, 1e-2, 1.0}) {
      CAPTURE(exponent, spread);
      CHECK(contacts_by<1>(pairs, draw, spread) == alone);
      CHECK(contacts_by<2>(pairs, draw, spread) == alone);
    }
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const SuperellipsoidContact contact = contact_of(pairs[k]);
      if (contact.overlap > 0) {
        REQUIRE(alone[k].size() == 7);
        CHECK(std::abs(alone[k][0] - contact.overlap) < 1e-12);
        CHECK(length_of(difference({alone[k][1], alone[k][2], alone[k][3]}, contact.n)) < 1e-8);
      } else {
        CHECK(alone[k].size() == 1);
      }
    }
  }
}

TEST_CASE("ellipsoids by their own formulas are the superellipsoids of exponents 2, radii of curvature too") {
  Draw draw;
  for (int k = 0; k < 2000; ++k) {
    CAPTURE(k);
    const auto ellipsoid = [&] {
      Superellipsoid s = draw.shape(4, 10);
      s.e = s.n = 2;
      return s;
    };
    const KnownPair known = known_pair(draw, ellipsoid(), ellipsoid(), 0, k % 4 ? 0.02 : 2);
    const OverlapPair& pair = known.pair;
    const EllipsoidPair<double> same = {ellipsoid_matrix(pair.form_i.half, pair.axes_i),
                                        ellipsoid_matrix(pair.form_j.half, pair.axes_j), pair.branch};
    Triple<double> guess = {0, 0, 0};
    const auto search = [&](int) { return searched_contact(pair); };
    const ContactsOf<double> found = contacts_of(same, guess, search);
    for (const double spread : {0.0, 1e-6, 1e-4, 1.0}) {
      Triple<double> other = plus(guess, spread, draw.direction());
      CHECK(numbers_of(contacts_of(same, other, search), 0) == numbers_of(found, 0));
    }
    const SuperellipsoidContact contact = contact_of(pair);
    CHECK(found.overlap == Approx(contact.overlap).margin(1e-12));
    CHECK(length_of(difference(found.n, contact.n)) < 1e-7);
    CHECK(length_of(difference(found.point, contact.point)) < 1e-6);
    const RadiiOfCurvature<double> radii = radii_of_curvature(contact.at.j);
    const auto own = radii_of_curvature(same.j, ellipsoid_at(same.j, contact.n));
    CHECK(own.sum == Approx(radii.sum).epsilon(1e-3));
    CHECK(own.product == Approx(radii.product).epsilon(1e-3));
  }
}

TEST_CASE("Hertz's radius from curvature: spheres, tips, flanks side by side and crossed, flat sides") {
  const Axes crossed = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};  // z of the body along -y
  const auto radius = [](const Superellipsoid& i, const Superellipsoid& j, const Vector& n, const Axes& axes_j) {
    const auto form_i = plain_form_of(i), form_j = plain_form_of(j);
    return hertz_radius(support_at(form_i, own_axes, n), support_at(form_j, axes_j, times(-1.0, n)),
                        largest_radius(form_i.half), largest_radius(form_j.half));
  };
  const double a = 1.3, b = 0.4;
  const Vector any = of_length_1(Vector{1, 2, 3});
  CHECK(radius({a, a, a, 2, 2}, {b, b, b, 2, 2}, any, crossed) == Approx(a * b / (a + b)).epsilon(1e-12));
  const Superellipsoid spheroid = {b, b, a, 2, 2};
  CHECK(radius(spheroid, spheroid, {0, 0, 1}, own_axes) == Approx(0.5 * b * b / a).epsilon(1e-12));
  // Flanks have the radii b and a^2/b.
  CHECK(radius(spheroid, spheroid, {1, 0, 0}, own_axes) == Approx(0.5 * a).epsilon(1e-12));
  CHECK(radius(spheroid, spheroid, {1, 0, 0}, crossed) == Approx(1 / (1 / b + b / (a * a))).epsilon(1e-12));
  const Superellipsoid block = {1, 1, 1, 8, 8};
  CHECK(radius(block, block, {0, 0, 1}, own_axes) == Approx(0.5 * flattest_side).epsilon(1e-12));
  Draw draw;
  for (const OverlapPair& pair : drawn_pairs(draw, 200, 2, 3)) {
    const Vector n = contact_of(pair).n;
    const EllipsoidPair<double> same = {ellipsoid_matrix(pair.form_i.half, pair.axes_i),
                                        ellipsoid_matrix(pair.form_j.half, pair.axes_j), pair.branch};
    const double general =
        hertz_radius(support_at(pair.form_i, pair.axes_i, n), support_at(pair.form_j, pair.axes_j, times(-1.0, n)),
                     largest_radius(pair.form_i.half), largest_radius(pair.form_j.half));
    CHECK(hertz_radius(same, n) == Approx(general).epsilon(1e-9));
  }
}

TEST_CASE("Radii of curvature lie within their bounds") {
  Draw draw;
  for (int k = 0; k < 300; ++k) {
    const Superellipsoid s = draw.shape(k % 2 == 0 ? 2 : 8, 5);
    const SuperellipsoidGrain::Radii bounds = SuperellipsoidGrain::radii_of_curvature({s.a, s.b, s.c, s.e, s.n});
    const RadiiOfCurvature<double> radii = radii_of_curvature(support_at(plain_form_of(s), own_axes, draw.direction()));
    if (!(radii.sum < 1e100)) continue;
    const double apart = std::sqrt(std::max(0.0, radii.sum * radii.sum - 4 * radii.product));
    CAPTURE(k, s.e, s.n);
    CHECK(2 * radii.product / (radii.sum + apart) > bounds.least * (1 - 1e-9));
    if (k % 2 == 0) CHECK(0.5 * (radii.sum + apart) < bounds.largest * (1 + 1e-9));
  }
}

TEST_CASE("forces and moments of two grains balance, and the work around any loop is none") {
  Draw draw;
  for (int k = 0; k < 12; ++k) {
    CAPTURE(k);
    const Superellipsoid si = draw.shape(4, 2), sj = draw.shape(4, 2);
    const KnownPair known = known_pair(draw, si, sj, 0, 0.2);
    const Axes axes_i = known.pair.axes_i, axes_j = known.pair.axes_j;
    TwoGrains grains;
    grains.set(0, si, {0.3, -0.2, 0.1}, axes_i);
    // Around a circle of shifts while the second grain turns about an axis and back.
    const Vector u = of_length_1(cross(known.n, draw.direction())), about = draw.direction();
    const double reach = 0.2 * known.depth;
    constexpr int steps = 400;
    double work = 0, most = 0;
    Vector x_last{}, turn_last{};
    NormalForces last{};
    for (int t = 0; t <= steps; ++t) {
      const double angle = 2 * std::numbers::pi * t / steps, turn = reach * std::sin(angle);
      const Vector x =
          plus(plus(known.pair.branch, reach * std::cos(angle), u), 0.5 * reach * std::sin(angle), known.n);
      grains.set(1, sj, plus(x, 1.0, {0.3, -0.2, 0.1}), rotated(rotation(about, turn), axes_j));
      const NormalForces now = grains.forces();
      REQUIRE(now.overlap > 0);
      const Vector arm = cross(x, now.force);  // moments about the centre of the first
      CHECK(length_of(plus(plus(now.moment_i, 1.0, now.moment_j), 1.0, arm)) < 1e-13 * length_of(now.force));
      if (t > 0) {
        const double part =
            0.5 * (dot(plus(now.force, 1.0, last.force), difference(x, x_last)) +
                   dot(plus(now.moment_j, 1.0, last.moment_j), difference(times(turn, about), turn_last)));
        work += part;
        most += std::abs(part);
      }
      last = now;
      x_last = x;
      turn_last = times(turn, about);
    }
    REQUIRE(most > 0);
    CHECK(std::abs(work) < 1e-4 * most);  // the trapezoidal rule of a loop
    // Pressed along n from the first touch on, the work is the energy of the overlap.
    double pressed = 0;
    constexpr int parts = 200;
    double before = 0;
    for (int t = 0; t <= parts; ++t) {
      const double in = known.depth * t / parts;
      const Vector x = plus(known.pair.branch, known.depth - in, known.n);
      grains.set(1, sj, plus(x, 1.0, {0.3, -0.2, 0.1}), axes_j);
      const double now = dot(grains.forces().force, known.n);
      if (t > 0) pressed += 0.5 * (now + before) * known.depth / parts;
      before = now;
    }
    CHECK(pressed == Approx(0.4 * Hertz{}(known.depth) * known.depth).epsilon(1e-4));
  }
}
