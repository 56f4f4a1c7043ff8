// Superellipsoids drawn at random, and pairs of which the answer is known: with X the points of both shapes along n and
// -n, d = X_i - X_j - depth n makes f(n) = depth stationary, and the least of all where the balls that roll inside both
// are not smaller (Blaschke).
#pragma once

#include <array>
#include <random>

#include "rvelab/superellipsoid/body.hpp"
#include "rvelab/superellipsoid/search.hpp"

namespace rvelab::test {
namespace {

using Vector = Triple<double>;
using Axes = SuperellipsoidAxes<double>;

inline double length_of(const Vector& v) { return std::sqrt(dot(v, v)); }
inline Vector difference(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// Axes of a body from its quaternion.
inline Axes axes_of(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}
inline Vector rotated(const Axes& turn, const Vector& v) { return in_world(turn, v); }
inline Axes rotated(const Axes& turn, const Axes& axes) {
  return {rotated(turn, axes.x), rotated(turn, axes.y), rotated(turn, axes.z)};
}
/// A rotation by an angle about a unit vector.
inline Axes rotation(const Vector& about, double angle) {
  const double s = std::sin(0.5 * angle);
  return axes_of({std::cos(0.5 * angle), s * about.x, s * about.y, s * about.z});
}

/// The same numbers on every machine.
struct Draw {
  std::mt19937_64 generator{20260101};
  double between(double low, double high) {
    return low + (high - low) * (double(generator() >> 11) / 9007199254740992.0);
  }
  Vector direction() {
    for (;;) {
      const Vector v = {between(-1, 1), between(-1, 1), between(-1, 1)};
      if (dot(v, v) < 1 && dot(v, v) > 0.01) return of_length_1(v);
    }
  }
  Axes axes() { return rotation(direction(), between(0, std::numbers::pi)); }
  /// One exponent in four is 2.
  Superellipsoid shape(double most_exponent, double most_aspect) {
    const auto axis = [&] { return std::pow(most_aspect, -between(0, 1)); };
    const auto exponent = [&] { return generator() % 4 == 0 ? 2.0 : between(2, most_exponent); };
    const double a = axis(), b = axis(), c = axis(), e = exponent();
    return {a, b, c, e, exponent()};
  }
};

struct KnownPair {
  OverlapPair pair;
  Vector n;
  double depth, rolling;
};
/// `way` 0: any direction; 1: that of any point of i (flat sides have many); 2: also a face of j against it, tilted by
/// 1 to 1e-12. The depth is `deepest` 1e-4 to 1 times the shortest half axis.
inline KnownPair known_pair(Draw& draw, const Superellipsoid& i, const Superellipsoid& j, int way, double deepest) {
  KnownPair known{{form_of(i), form_of(j), draw.axes(), draw.axes(), {}}, draw.direction(), 0, 0};
  OverlapPair& pair = known.pair;
  if (way > 0) known.n = normal_at(pair.form_i, pair.axes_i, known.n);
  if (way == 2) {
    const Vector& z = known.n;
    const Vector x = of_length_1(cross(z, draw.direction())), y = cross(z, x);
    const Axes face = rotated(rotation(x, std::pow(10, -draw.between(0, 12))), Axes{x, y, z});
    const Axes turned[3] = {{face.x, face.y, face.z}, {face.y, face.z, face.x}, {face.z, face.x, face.y}};
    pair.axes_j = turned[draw.generator() % 3];
  }
  const Place there = overlap_at(pair, known.n);
  known.depth = deepest * std::min(inner_radius_of(i), inner_radius_of(j)) * std::pow(10, -draw.between(0, 4));
  known.rolling = pair.form_i.rolling + pair.form_j.rolling;
  pair.branch = plus(difference(there.i.point, there.j.point), -known.depth, known.n);
  return known;
}

}  // namespace
}  // namespace rvelab::test
