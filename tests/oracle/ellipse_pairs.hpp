// Pairs of ellipses of every kind, and their overlap by looking everywhere.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "rvelab/solver/kernels/ellipse_search.hpp"

namespace rvelab::test {

/// Axes a >= b (m), and the long one's angle against x.
struct TestEllipse {
  double a, b, angle;
  EllipseMatrix<double> matrix() const {
    const double c = std::cos(angle), s = std::sin(angle);
    return {a * a * c * c + b * b * s * s, (a * a - b * b) * c * s, a * a * s * s + b * b * c * c, b * b / a};
  }
};

enum class Meeting { touching, deep, aligned, tip_to_tip, anywhere, on_the_evolute };
inline constexpr std::array meetings = {Meeting::touching,   Meeting::deep,     Meeting::aligned,
                                        Meeting::tip_to_tip, Meeting::anywhere, Meeting::on_the_evolute};

/// The pair whose f has the value `depth` at the direction of `angle`, with no slope there.
inline EllipsePair<double> pair_at(const TestEllipse& i, const TestEllipse& j, double angle, double depth) {
  EllipsePair<double> p{0, 0, i.matrix(), j.matrix()};
  const double x = std::cos(angle), y = std::sin(angle);
  const EllipseGap<double> g = ellipse_gap(p, {x, y});
  const double along = g.support_i + g.support_j - depth, across = g.turned_i + g.turned_j;
  p.x = along * x - across * y;
  p.y = along * y + across * x;
  return p;
}

/// Long axes of 1 to 2 m, aspect 1 to 10.
class EllipsePairs {
 public:
  explicit EllipsePairs(std::uint64_t seed) : generator_(seed) {}

  EllipsePair<double> draw(Meeting meeting) {
    TestEllipse i = ellipse(), j = ellipse();
    double normal = 2 * M_PI * uniform();
    if (meeting == Meeting::aligned) {  // flank to flank in half of them, and equal in some
      if (uniform() < 0.5) j.a = i.a, j.b = i.b;
      j.angle = i.angle + nearly(0.5e-3) + (uniform() < 0.5 ? 0 : M_PI / 2);
      if (uniform() < 0.5) normal = i.angle + M_PI / 2 + nearly(0.5e-2);
    }
    if (meeting == Meeting::tip_to_tip) {
      i.b = i.a / (1 + 9 * uniform());
      j.angle = i.angle + nearly(0.5e-3);
      normal = i.angle + nearly(0.5e-2);
    }
    const EllipseGap<double> g = ellipse_gap(EllipsePair<double>{0, 0, i.matrix(), j.matrix()},
                                             Direction<double>{std::cos(normal), std::sin(normal)});
    return pair_at(i, j, normal, depth(meeting, g, j));
  }

 private:
  double uniform() { return uniform_(generator_); }
  /// Zero, or a little to either side.
  double nearly(double size) { return uniform() < 0.3 ? 0 : size * (2 * uniform() - 1); }
  TestEllipse ellipse() {
    const double a = 1 + uniform();
    return {a, a * std::pow(10, -uniform()), 2 * M_PI * uniform()};
  }
  double depth(Meeting meeting, const EllipseGap<double>& g, const TestEllipse& j) {
    const double width = g.support_i + g.support_j;
    switch (meeting) {
      case Meeting::touching:
        return 1e-3 * (uniform() - 0.3);
      case Meeting::deep:
        return uniform() * width;
      case Meeting::aligned:
      case Meeting::tip_to_tip:
        return (4 * uniform() - 0.2) * j.b * j.b / j.a;
      case Meeting::anywhere:
        return (1.5 * uniform() - 0.3) * width;
      case Meeting::on_the_evolute:  // as deep as the radii of curvature: there minima meet
        return g.curvature + g.overlap + (uniform() < 0.5 ? 0 : 1e-3 * (uniform() - 0.5));
    }
    return 0;
  }

  std::mt19937_64 generator_;
  std::uniform_real_distribution<double> uniform_{0, 1};
};

/// f of a pair from its definition, with numbers of one type throughout.
template <class Real>
Real gap_by_definition(const EllipsePair<double>& p, Real x, Real y) {
  const auto support = [&](const EllipseMatrix<double>& m) {
    return std::sqrt(Real(m.xx) * x * x + 2 * Real(m.xy) * x * y + Real(m.yy) * y * y);
  };
  return support(p.i) + support(p.j) - (x * Real(p.x) + y * Real(p.y));
}

/// Least f between two angles, by golden section.
template <class Real>
Real least_between(const EllipsePair<double>& p, Real low, Real high, int cuts) {
  const Real golden = Real(0.6180339887498948482L);
  const auto at = [&](Real angle) { return gap_by_definition(p, std::cos(angle), std::sin(angle)); };
  Real a = high - golden * (high - low), b = low + golden * (high - low), of_a = at(a), of_b = at(b);
  for (int k = 0; k < cuts; ++k) {
    if (of_a < of_b) {
      high = b, b = a, of_b = of_a;
      of_a = at(a = high - golden * (high - low));
    } else {
      low = a, a = b, of_a = of_b;
      of_b = at(b = low + golden * (high - low));
    }
  }
  return std::min(of_a, of_b);
}

/// The least f over 4,096 directions, with golden section from every one that is below its neighbours.
inline long double overlap_by_all_directions(const EllipsePair<double>& p) {
  constexpr int count = 4096;
  constexpr long double step = 2 * 3.14159265358979323846264338327950288L / count;
  static const std::vector<std::array<long double, 2>> directions = [] {
    std::vector<std::array<long double, 2>> made(count);
    for (int k = 0; k < count; ++k) made[std::size_t(k)] = {std::cos(k * step), std::sin(k * step)};
    return made;
  }();
  std::vector<long double> f(count);
  for (std::size_t k = 0; k < count; ++k) f[k] = gap_by_definition(p, directions[k][0], directions[k][1]);
  long double least = f[0];
  for (std::size_t k = 0; k < count; ++k)
    if (f[k] <= f[(k + count - 1) % count] && f[k] <= f[(k + 1) % count])
      least = std::min(least, least_between(p, (double(k) - 1) * step, (double(k) + 1) * step, 45));
  return least;
}

/// The least f over the normals at 24 places of either ellipse, close together where it is sharp, with golden section
/// around the three lowest: fast, and with nothing in common with the kernel.
inline double overlap_by_few_directions(const EllipsePair<double>& p) {
  constexpr int places = 24;
  std::array<double, 2 * places> angles;
  for (int e = 0; e < 2; ++e) {
    const EllipseMatrix<double>& m = e == 0 ? p.i : p.j;
    const double half = std::hypot(0.5 * (m.xx - m.yy), m.xy), mean = 0.5 * (m.xx + m.yy);
    const double a = std::sqrt(mean + half), b = a * m.sharpest, axis = 0.5 * std::atan2(m.xy, 0.5 * (m.xx - m.yy));
    const double minor = std::sqrt(b);
    for (int k = 0; k < places; ++k) {
      const double around = 2 * M_PI * (k + 0.5) / places;
      angles[std::size_t(places * e + k)] =
          std::remainder(axis + std::atan2(std::sin(around) * a, std::cos(around) * minor), 2 * M_PI);
    }
  }
  std::sort(angles.begin(), angles.end());
  std::array<std::pair<double, std::size_t>, 2 * places> f;
  for (std::size_t k = 0; k < f.size(); ++k) f[k] = {gap_by_definition(p, std::cos(angles[k]), std::sin(angles[k])), k};
  std::partial_sort(f.begin(), f.begin() + 3, f.end());
  double least = f[0].first;
  for (std::size_t low = 0; low < 3; ++low) {
    const std::size_t k = f[low].second, n = f.size();
    const double from = k == 0 ? angles[n - 1] - 2 * M_PI : angles[k - 1];
    const double to = k + 1 == n ? angles[0] + 2 * M_PI : angles[k + 1];
    least = std::min(least, least_between(p, from, to, 34));
  }
  return least;
}

}  // namespace rvelab::test
