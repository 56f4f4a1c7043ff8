#include "rvelab/grains/filling.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <utility>

#include "rvelab/cell/cube_root.hpp"

namespace rvelab {

namespace {

using Eigen::Vector3d;

/// Points of the surface, for medial balls and for the distances that are reported.
constexpr std::size_t point_count = 2000;
/// Halvings of the distance that counts as near: to a thousandth of the radius.
constexpr int halvings = 10;

struct SurfacePoint {
  Vector3d at, normal;
};

/// Evenly over the area: by the additive recurrence of the plastic number (Roberts 2018) in each triangle.
std::vector<SurfacePoint> points_of(const Mesh& mesh) {
  std::vector<double> up_to;
  double area = 0;
  const auto corner = [&](std::size_t t, std::size_t k) { return mesh.corners[std::size_t(mesh.triangles[t][k])]; };
  const auto twice_area = [&](std::size_t t) {
    return Vector3d((corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)));
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) up_to.push_back(area += twice_area(t).norm());
  std::vector<SurfacePoint> points;
  double u = 0.5, v = 0.5;
  for (std::size_t k = 0; k < point_count; ++k) {
    const double at = (double(k) + 0.5) / double(point_count) * area;
    const auto t = std::size_t(std::upper_bound(up_to.begin(), up_to.end() - 1, at) - up_to.begin());
    u += 0.7548776662466927;
    v += 0.5698402909980532;
    u -= std::floor(u);
    v -= std::floor(v);
    const double root = std::sqrt(u);
    points.push_back({(1 - root) * corner(t, 0) + root * (1 - v) * corner(t, 1) + root * v * corner(t, 2),
                      twice_area(t).normalized()});
  }
  return points;
}

/// The largest ball inside that touches the surface at a point.
Ball medial_ball(const std::vector<SurfacePoint>& points, std::size_t at, double largest) {
  const auto& [p, n] = points[at];
  double radius = largest;
  while (true) {
    const Vector3d centre = p - radius * n;
    double least = std::numeric_limits<double>::infinity();
    std::size_t nearest = at;
    for (std::size_t k = 0; k < points.size(); ++k)
      if (const double d = (points[k].at - centre).squaredNorm(); k != at && d < least) least = d, nearest = k;
    const Vector3d apart = p - points[nearest].at;
    const double next = apart.squaredNorm() / (2 * apart.dot(n));
    // Neighbours in one plane, or none within the ball.
    if (!(next > 0) || !(next < radius * (1 - 1e-6))) return {centre, radius};
    radius = next;
  }
}

/// Balls, and how far each point of the surface is from each, m; a row is a ball.
struct Candidates {
  std::vector<Ball> balls;
  std::vector<std::vector<double>> distance;
  bool overlap(std::size_t a, std::size_t b) const {
    return (balls[a].at - balls[b].at).norm() < balls[a].radius + balls[b].radius;
  }
};
Candidates candidates_of(const std::vector<SurfacePoint>& points, std::vector<Ball> balls) {
  Candidates all{std::move(balls), {}};
  for (const Ball& ball : all.balls) {
    std::vector<double>& row = all.distance.emplace_back();
    for (const SurfacePoint& p : points) row.push_back(std::max(0.0, (p.at - ball.at).norm() - ball.radius));
  }
  return all;
}

using Points = std::bitset<point_count>;

/// Rows that are chosen until every point is near to one, or one more than `most`. All but the first overlap one that
/// was chosen before, so that they hang together.
std::vector<std::size_t> chosen(const Candidates& candidates, double near, std::size_t most) {
  const std::size_t count = candidates.balls.size();
  std::vector<Points> covers(count);
  for (std::size_t b = 0; b < count; ++b)
    for (std::size_t k = 0; k < point_count; ++k) covers[b][k] = candidates.distance[b][k] <= near;
  std::vector<std::size_t> rows;
  std::vector<bool> reached(count, true);
  Points open;
  open.set();
  while (open.any() && rows.size() <= most) {
    std::size_t best = 0, best_gain = 0;
    for (std::size_t b = 0; b < count; ++b)
      if (const std::size_t gain = reached[b] ? (covers[b] & open).count() : 0; gain > best_gain)
        best = b, best_gain = gain;
    if (best_gain == 0) return std::vector<std::size_t>(most + 1);  // none within reach
    open &= ~covers[best];
    if (rows.empty()) std::fill(reached.begin(), reached.end(), false);
    rows.push_back(best);
    for (std::size_t b = 0; b < count; ++b) reached[b] = reached[b] || candidates.overlap(best, b);
  }
  return rows;
}

/// Principal moments over volume^(5/3), ascending.
Vector3d shape_of_inertia(const MassProperties& p) {
  const double root = cube_root(p.volume);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(p.inertia).eigenvalues() / (p.volume * root * root);
}

}  // namespace

Filling filled(const Mesh& mesh, int most) {
  const MassProperties grain = properties_of(mesh);
  constexpr double pi = 3.14159265358979323846;
  const double radius = cube_root(grain.volume / (4.0 / 3.0 * pi));
  Vector3d low = mesh.corners.front(), high = low;
  for (const Vector3d& x : mesh.corners) low = low.cwiseMin(x), high = high.cwiseMax(x);
  const std::vector<SurfacePoint> points = points_of(mesh);
  std::vector<Ball> balls;
  for (std::size_t k = 0; k < points.size(); ++k) {
    Ball ball = medial_ball(points, k, (high - low).norm());
    ball.radius = distance_to(mesh, ball.at, ball.radius);  // points leave gaps: within the surface itself
    if (ball.radius > 1e-3 * radius) balls.push_back(ball);
  }
  const Candidates candidates = candidates_of(points, std::move(balls));
  double near = 0, enough = (high - low).norm();
  std::vector<std::size_t> rows = chosen(candidates, enough, std::size_t(most));
  for (int k = 0; k < halvings; ++k) {
    const double middle = k == 0 ? radius : (near + enough) / 2;
    std::vector<std::size_t> found = chosen(candidates, middle, std::size_t(most));
    const bool fits = found.size() <= std::size_t(most);
    (fits ? enough : near) = middle;
    if (fits) rows = std::move(found);
  }
  Filling filling;
  for (std::size_t k = 0; k < points.size(); ++k) {
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t b : rows) least = std::min(least, candidates.distance[b][k]);
    filling.mean_distance += least / radius / double(points.size());
    filling.largest_distance = std::max(filling.largest_distance, least / radius);
  }
  for (const std::size_t b : rows) filling.spheres.push_back(candidates.balls[b]);
  std::stable_sort(filling.spheres.begin(), filling.spheres.end(),
                   [](const Ball& a, const Ball& b) { return a.radius > b.radius; });
  const MassProperties clump = union_of_spheres(filling.spheres);
  filling.volume_ratio = clump.volume / grain.volume;
  const Vector3d ratios = shape_of_inertia(clump).cwiseQuotient(shape_of_inertia(grain));
  filling.inertia_ratio = ratios.minCoeff();
  filling.largest_inertia_ratio = ratios.maxCoeff();
  return filling;
}

}  // namespace rvelab
