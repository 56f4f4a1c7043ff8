#include "tools/voids/pores.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace rvelab::voids {
namespace {

/// The grains of a simplex and all that share a simplex with one of them, as corners.
class Neighbours {
 public:
  Neighbours(const std::vector<Simplex>& simplices, std::size_t balls) : of_(balls) {
    for (const Simplex& simplex : simplices)
      for (const Corner& a : simplex)
        for (const Corner& b : simplex)
          of_[std::size_t(a.ball)].insert(
              {b.ball, {b.image[0] - a.image[0], b.image[1] - a.image[1], b.image[2] - a.image[2]}});
  }

  std::set<Corner> around(const Simplex& simplex) const {
    std::set<Corner> all;
    for (const Corner& a : simplex)
      for (const Corner& b : of_[std::size_t(a.ball)])
        all.insert({b.ball, {a.image[0] + b.image[0], a.image[1] + b.image[1], a.image[2] + b.image[2]}});
    return all;
  }

 private:
  std::vector<std::set<Corner>> of_;  ///< neighbours of the copy of each ball in the cell itself, that copy included
};

/// Coordinates within the affine space of the points: edges from the first, made orthonormal.
Eigen::MatrixXd frame_of(const std::vector<Ball>& balls) {
  Eigen::MatrixXd edges(3, Eigen::Index(balls.size()) - 1);
  for (std::size_t k = 1; k < balls.size(); ++k) edges.col(Eigen::Index(k) - 1) = balls[k].position - balls[0].position;
  const Eigen::MatrixXd q = edges.householderQr().householderQ();
  return q.leftCols(edges.cols());
}

/// All lists of the simplex without one corner.
std::vector<Simplex> faces_of(const Simplex& simplex) {
  std::vector<Simplex> faces;
  for (std::size_t left_out = 0; left_out < simplex.size(); ++left_out) {
    faces.push_back(simplex);
    faces.back().erase(faces.back().begin() + std::ptrdiff_t(left_out));
  }
  return faces;
}

struct Geometry {
  const PeriodicCell& cell;
  const std::vector<Ball>& balls;

  Ball at(const Corner& corner) const {
    const Ball& ball = balls[std::size_t(corner.ball)];
    return {ball.position + cell.translation(corner.image), ball.radius};
  }
  std::vector<Ball> at(const Simplex& simplex) const {
    std::vector<Ball> all;
    for (const Corner& corner : simplex) all.push_back(at(corner));
    return all;
  }
};

/// By the corners that a pore touches: where more than d + 1 grains lie on one sphere, as in crystals, all simplices
/// of these give the same pore.
using ByCorners = std::map<Simplex, Pore>;

/// Grains of `near` that a pore touches; empty if one of them intersects it.
Simplex touched_near(const Geometry& geometry, const std::set<Corner>& near, const Pore& pore, double tolerance) {
  Simplex touched;
  for (const Corner& corner : near) {
    const Ball ball = geometry.at(corner);
    const double gap = (ball.position - pore.centre).norm() - ball.radius - pore.radius;
    if (gap < -tolerance) return {};
    if (gap < tolerance) touched.push_back(corner);
  }
  return touched;
}

/// Adds the ball that touches all corners, if its radius is positive and no neighbour intersects it.
void add_pore(const Geometry& geometry, const Simplex& corners, const Neighbours& neighbours, ByCorners& pores) {
  Pore pore;
  if (!touching_ball(geometry.at(corners), pore)) return;
  const double tolerance = 1e-6 * geometry.balls[std::size_t(corners[0].ball)].radius;
  if (!(pore.radius > tolerance)) return;
  // With more than d + 1 grains, the neighbours of those found first may include others.
  Simplex touched = corners;
  for (std::size_t before = 0; touched.size() != before;) {
    before = touched.size();
    touched = touched_near(geometry, neighbours.around(touched), pore, tolerance);
    if (touched.empty()) return;
  }
  pores.emplace(canonical(std::move(touched)), pore);
}

std::vector<Pore> listed(const ByCorners& pores) {
  std::vector<Pore> all;
  for (const auto& [corners, pore] : pores) all.push_back(pore);
  return all;
}

}  // namespace

bool touching_ball(const std::vector<Ball>& balls, Pore& found) {
  // |c - x_k| = r + r_k; the difference of two is linear: M c = g + h r, and the first then gives r.
  const Eigen::MatrixXd frame = frame_of(balls);
  const Eigen::Index d = frame.cols();
  Eigen::MatrixXd m(d, d);
  Eigen::VectorXd g(d), h(d);
  const double r0 = balls[0].radius;
  for (Eigen::Index k = 0; k < d; ++k) {
    const auto& [x, radius] = balls[std::size_t(k) + 1];
    const Eigen::VectorXd edge = frame.transpose() * (x - balls[0].position);
    m.row(k) = edge.transpose();
    g[k] = 0.5 * (edge.squaredNorm() - radius * radius + r0 * r0);
    h[k] = r0 - radius;
  }
  const auto solver = m.partialPivLu();
  const Eigen::VectorXd c0 = solver.solve(g), c1 = solver.solve(h);
  // (c1.c1 - 1) r^2 + 2 (c0.c1 - r0) r + c0.c0 - r0^2 = 0
  const double a = c1.squaredNorm() - 1, b = c0.dot(c1) - r0, c = c0.squaredNorm() - r0 * r0;
  const double root = std::sqrt(b * b - a * c);
  if (!std::isfinite(root)) return false;
  const double far = b > 0 ? -b - root : -b + root;  // the two are far/a and c/far
  double least = 0;
  bool any = false;
  for (const double r : {far / a, c / far}) {
    const bool outside = std::all_of(balls.begin(), balls.end(), [&](const Ball& ball) { return r + ball.radius > 0; });
    if (!std::isfinite(r) || !outside || (any && r >= least)) continue;
    least = r;
    any = true;
  }
  found.radius = least;
  found.centre = balls[0].position + frame * (c0 + c1 * least);
  return any;
}

Pores pores(const PeriodicCell& cell, const std::vector<Ball>& balls, const PowerCells& cells) {
  const Geometry geometry{cell, balls};
  const Neighbours neighbours(cells.simplices, balls.size());
  ByCorners bodies, throats;
  std::set<Simplex> faces;
  for (const Simplex& simplex : cells.simplices) {
    add_pore(geometry, simplex, neighbours, bodies);
    for (Simplex& face : faces_of(simplex)) faces.insert(canonical(std::move(face)));
  }
  for (const Simplex& face : faces) add_pore(geometry, face, neighbours, throats);
  // A plane through the centre of a body that touches more than d + 1 grains is no throat.
  for (const auto& [corners, body] : bodies) throats.erase(corners);
  return {listed(bodies), listed(throats)};
}

std::vector<double> local_void_ratios(const PeriodicCell& cell, const std::vector<Ball>& balls,
                                      const PowerCells& cells) {
  std::vector<double> ratios;
  const double pi = std::numbers::pi;
  for (std::size_t k = 0; k < balls.size(); ++k) {
    const double r = balls[k].radius;
    const double solid = cell.dimension == 2 ? pi * r * r * cell.lattice(2, 2) : 4 * pi / 3 * r * r * r;
    ratios.push_back((cells.volume[k] - solid) / solid);
  }
  return ratios;
}

double specific_surface(const std::vector<Ball>& balls, int dimension) {
  double surface = 0, volume = 0;  // d r^(d-1) and r^d: of one r, d/r
  for (const Ball& ball : balls) {
    surface += dimension * std::pow(ball.radius, dimension - 1);
    volume += std::pow(ball.radius, dimension);
  }
  return surface / volume;
}

double kozeny_carman(double void_ratio, double specific_surface, double constant) {
  return void_ratio * void_ratio * void_ratio / (constant * specific_surface * specific_surface * (1 + void_ratio));
}

}  // namespace rvelab::voids
