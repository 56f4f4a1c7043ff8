// Arcs are given by the directions of their ends, cut in halves until they are short, and integrated in t = tan of half
// the angle from their middle: no function of libm, so that a clump has the same bits on every machine.
#include "rvelab/grains/union.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace rvelab {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Nodes > 0 and weights of Gauss and Legendre of order 16 on (-1, 1).
constexpr double gauss[8][2] = {
    {0.095012509837637454, 0.18945061045506859}, {0.28160355077925892, 0.18260341504492361},
    {0.45801677765722737, 0.16915651939500262},  {0.61787624440264377, 0.14959598881657676},
    {0.755404408355003, 0.12462897125553403},    {0.86563120238783176, 0.095158511682492591},
    {0.9445750230732326, 0.062253523938647706},  {0.98940093499164994, 0.027152459411754037}};

/// at(node, weight) on (-1, 1).
template <class At>
void each_node(const At& at) {
  for (const auto& [x, w] : gauss) {
    at(-x, w);
    at(x, w);
  }
}

struct Disc2 {
  Vector2d at;
  double radius;
};

/// Integrals of 1, x, y, x^2, y^2, xy.
using AreaMoments = Eigen::Matrix<double, 6, 1>;

/// Ascends with the angle of a direction, 0 to 4.
double turn_in_order(const Vector2d& d) { return d.y() >= 0 ? 1 - d.x() : 3 + d.x(); }

/// Middle of the arc from one direction to another, counter-clockwise.
Vector2d middle_of(const Vector2d& from, const Vector2d& to) {
  const double cross = from.x() * to.y() - from.y() * to.x();
  const Vector2d sum = from + to, quarter(-from.y(), from.x());
  const double length = sum.norm();
  if (length < 1e-3) {  // about half a turn: by the middle of the chord's normal
    const Vector2d chord = to - from;
    return Vector2d(chord.y(), -chord.x()).normalized();
  }
  if (cross == 0 && from.dot(to) > 0) return -from;  // a whole turn
  return (cross < 0 ? -1.0 : 1.0) / length * sum;
}

/// The line integrals of Green's theorem along an arc.
void add_arc(const Disc2& disc, const Vector2d& from, const Vector2d& to, int depth, AreaMoments& sum) {
  const Vector2d middle = middle_of(from, to);
  if (depth > 0) {
    add_arc(disc, from, middle, depth - 1, sum);
    add_arc(disc, middle, to, depth - 1, sum);
    return;
  }
  const Vector2d across(-middle.y(), middle.x());
  const double sine = to.dot(across), reach = sine / (1 + to.dot(middle));
  each_node([&](double node, double weight) {
    const double t = reach * node, scale = 1 / (1 + t * t);
    const Vector2d d = (1 - t * t) * scale * middle + 2 * t * scale * across;
    const double step = weight * reach * 2 * scale * disc.radius;
    const double x = disc.at.x() + disc.radius * d.x(), y = disc.at.y() + disc.radius * d.y();
    const double dx = -d.y() * step, dy = d.x() * step;
    AreaMoments m;
    m << x * dy, 0.5 * x * x * dy, -0.5 * y * y * dx, x * x * x * dy / 3, -y * y * y * dx / 3, 0.5 * x * x * y * dy;
    sum += m;
  });
}

bool within(const Disc2& inner, const Disc2& outer) {
  return (inner.at - outer.at).norm() + inner.radius <= outer.radius * (1 + 1e-15);
}

/// Those that no other one covers; of equal ones the first.
std::vector<Disc2> seen(const std::vector<Disc2>& discs) {
  std::vector<Disc2> left;
  for (std::size_t k = 0; k < discs.size(); ++k) {
    bool hidden = false;
    for (std::size_t o = 0; o < discs.size(); ++o)
      hidden |= o != k && within(discs[k], discs[o]) && (!within(discs[o], discs[k]) || o < k);
    if (!hidden) left.push_back(discs[k]);
  }
  return left;
}

AreaMoments moments_of(const std::vector<Disc2>& all) {
  const std::vector<Disc2> discs = seen(all);
  AreaMoments sum = AreaMoments::Zero();
  std::vector<Vector2d> cuts;
  for (const Disc2& disc : discs) {
    cuts = {Vector2d(1, 0)};
    for (const Disc2& other : discs) {
      const Vector2d d = other.at - disc.at;
      const double squared = d.squaredNorm(), length = std::sqrt(squared);
      if (&other == &disc || length >= disc.radius + other.radius || length <= std::abs(disc.radius - other.radius))
        continue;
      const double along = (squared + disc.radius * disc.radius - other.radius * other.radius) / (2 * length);
      const double across = std::sqrt(std::max(0.0, disc.radius * disc.radius - along * along));
      const Vector2d n = d / length, t(-n.y(), n.x());
      for (const double side : {-1.0, 1.0}) cuts.push_back((along * n + side * across * t).normalized());
    }
    std::sort(cuts.begin(), cuts.end(),
              [](const Vector2d& a, const Vector2d& b) { return turn_in_order(a) < turn_in_order(b); });
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const Vector2d &from = cuts[k], &to = cuts[(k + 1) % cuts.size()];
      if (cuts.size() > 1 && from == to) continue;
      const Vector2d point = disc.at + disc.radius * middle_of(from, to);
      const bool covered = std::any_of(discs.begin(), discs.end(), [&](const Disc2& other) {
        return &other != &disc && (point - other.at).squaredNorm() < other.radius * other.radius;
      });
      if (!covered) add_arc(disc, from, to, 3, sum);
    }
  }
  return sum;
}

/// Heights at which the section of a union changes its kind: ends of spheres, of the circles in which two meet, and
/// points of three. Of many spheres those that none of the others hides: 40 spheres in an
/// ellipsoid take 0.8 instead of 19 s, to the same 1e-14.
std::vector<double> heights_of_changes(const std::vector<Ball>& s) {
  constexpr std::size_t few = 8;
  std::vector<double> z;
  const auto add = [&](const Vector3d& point, double height) {
    const auto hides = [&](const Ball& ball) { return (point - ball.at).norm() < ball.radius * (1 - 1e-9); };
    if (s.size() <= few || std::none_of(s.begin(), s.end(), hides)) z.push_back(height);
  };
  for (const Ball& ball : s)
    for (const double side : {-1.0, 1.0})
      add(ball.at + side * ball.radius * Vector3d::UnitZ(), ball.at.z() + side * ball.radius);
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3d d = s[j].at - s[i].at;
      const double length = d.norm(), ri = s[i].radius, rj = s[j].radius;
      if (length >= ri + rj || length <= std::abs(ri - rj)) continue;
      const double along = (ri * ri - rj * rj + length * length) / (2 * length);
      const Vector3d n = d / length, middle = s[i].at + along * n;
      const double radius = std::sqrt(std::max(0.0, ri * ri - along * along));
      const double steepness = std::sqrt(std::max(0.0, 1 - n.z() * n.z()));
      const Vector3d up = steepness > 0 ? Vector3d((Vector3d::UnitZ() - n.z() * n) / steepness) : Vector3d::Zero();
      for (const double side : {-1.0, 1.0}) add(middle + side * radius * up, middle.z() + side * radius * steepness);
      for (std::size_t k = 0; k < j; ++k) {
        // On that circle, at the radius of the third sphere from its centre.
        const Vector3d to_third = s[k].at - middle, in_plane = to_third - to_third.dot(n) * n;
        const double far = in_plane.norm(), rk = s[k].radius;
        if (!(far > 1e-12 * rk)) continue;
        const double wanted = (to_third.squaredNorm() + radius * radius - rk * rk) / (2 * far);
        const double left = radius * radius - wanted * wanted;
        if (!(left > 0)) continue;
        const Vector3d e = in_plane / far, f = n.cross(e);
        for (const double side : {-1.0, 1.0}) {
          const Vector3d point = middle + wanted * e + side * std::sqrt(left) * f;
          add(point, point.z());
        }
      }
    }
  std::sort(z.begin(), z.end());
  return z;
}

}  // namespace

MassProperties union_of_discs(const std::vector<Ball>& balls) {
  std::vector<Disc2> discs;
  for (const Ball& ball : balls) discs.push_back({ball.at.head<2>(), ball.radius});
  const AreaMoments m = moments_of(discs);
  MassProperties p;
  p.volume = m[0];
  p.centre = Vector3d(m[1], m[2], 0) / m[0];
  p.inertia(2, 2) = m[3] + m[4] - m[0] * p.centre.squaredNorm();
  return p;
}

MassProperties union_of_spheres(const std::vector<Ball>& spheres) {
  const std::vector<double> heights = heights_of_changes(spheres);
  double volume = 0;
  Vector3d first = Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t k = 1; k < heights.size(); ++k) {
    const double low = heights[k - 1], height = heights[k] - low;
    if (!(height > 1e-14 * (heights.back() - heights.front()))) continue;
    const auto add_section = [&](double s, double weight) {
      // z = low + height s^2 (3 - 2 s): roots at both ends become smooth.
      const double z = low + height * s * s * (3 - 2 * s), step = weight * height * 6 * s * (1 - s);
      std::vector<Disc2> discs;
      for (const Ball& ball : spheres) {
        const double up = z - ball.at.z(), squared = (ball.radius - up) * (ball.radius + up);
        if (squared > 0) discs.push_back({ball.at.head<2>(), std::sqrt(squared)});
      }
      if (discs.empty()) return;
      const AreaMoments m = step * moments_of(discs);
      volume += m[0];
      first += Vector3d(m[1], m[2], z * m[0]);
      Eigen::Matrix3d here;
      here << m[3], m[5], z * m[1], m[5], m[4], z * m[2], z * m[1], z * m[2], z * z * m[0];
      second += here;
    };
    constexpr int panels = 4;  // one: 3e-11 of the volume, and 1e-9 where a section of three spheres closes
    for (int panel = 0; panel < panels; ++panel)
      each_node(
          [&](double node, double weight) { add_section((panel + 0.5 * (1 + node)) / panels, 0.5 / panels * weight); });
  }
  MassProperties p;
  p.volume = volume;
  p.centre = first / volume;
  second -= volume * p.centre * p.centre.transpose();
  p.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  return p;
}

}  // namespace rvelab
