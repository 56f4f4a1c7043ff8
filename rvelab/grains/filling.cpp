#include "rvelab/grains/filling.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/cell/cube_root.hpp"

namespace rvelab {

namespace {

using Eigen::Vector3d;

/// Points of the surface; those of medial balls and errors are the same. 2,000 and 8,000 state the same error of a
/// cube, an ellipsoid and a screw within a tenth.
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

/// Distances of the points to each ball; a row is a ball.
std::vector<std::vector<double>> distances(const std::vector<SurfacePoint>& points, const std::vector<Ball>& balls) {
  std::vector<std::vector<double>> all;
  for (const Ball& ball : balls) {
    std::vector<double>& row = all.emplace_back();
    for (const SurfacePoint& p : points) row.push_back(std::max(0.0, (p.at - ball.at).norm() - ball.radius));
  }
  return all;
}

/// Rows that are chosen until every point is near to one, or one more than `most`.
std::vector<std::size_t> chosen(const std::vector<std::vector<double>>& distance, double near, std::size_t most) {
  std::vector<std::size_t> rows;
  std::vector<bool> done(distance.front().size(), false);
  while (rows.size() <= most) {
    std::size_t best = 0, best_gain = 0;
    for (std::size_t b = 0; b < distance.size(); ++b) {
      std::size_t gain = 0;
      for (std::size_t k = 0; k < done.size(); ++k) gain += !done[k] && distance[b][k] <= near;
      if (gain > best_gain) best = b, best_gain = gain;
    }
    if (best_gain == 0) break;
    rows.push_back(best);
    for (std::size_t k = 0; k < done.size(); ++k) done[k] = done[k] || distance[best][k] <= near;
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
  const auto distance = distances(points, balls);
  double near = 0, enough = (high - low).norm();
  std::vector<std::size_t> rows = chosen(distance, enough, std::size_t(most));
  for (int k = 0; k < halvings; ++k) {
    const double middle = k == 0 ? radius : (near + enough) / 2;
    std::vector<std::size_t> found = chosen(distance, middle, std::size_t(most));
    const bool fits = found.size() <= std::size_t(most);
    (fits ? enough : near) = middle;
    if (fits) rows = std::move(found);
  }
  Filling filling;
  for (std::size_t k = 0; k < points.size(); ++k) {
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t b : rows) least = std::min(least, distance[b][k]);
    filling.mean_distance += least / radius / double(points.size());
    filling.largest_distance = std::max(filling.largest_distance, least / radius);
  }
  for (const std::size_t b : rows) filling.spheres.push_back(balls[b]);
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
