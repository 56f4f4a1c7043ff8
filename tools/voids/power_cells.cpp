#include "tools/voids/power_cells.hpp"

#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"

namespace rvelab::voids {
namespace {

template <class Number>
using Rows = std::array<std::array<Number, 4>, 3>;  // three coefficients and the right side

template <class Number>
Number determinant(const Rows<Number>& m, int x, int y, int z) {
  return m[0][x] * (m[1][y] * m[2][z] - m[1][z] * m[2][y]) - m[0][y] * (m[1][x] * m[2][z] - m[1][z] * m[2][x]) +
         m[0][z] * (m[1][x] * m[2][y] - m[1][y] * m[2][x]);
}

/// 2 (x_k - x_0).c = |x_k - x_0|^2 - r_k^2 + r_0^2, c from x_0. In the plane the third row holds c_z = 0.
template <class Number>
Rows<Number> equal_powers(const std::vector<Ball>& corners) {
  Rows<Number> rows;
  for (auto& row : rows) row.fill(Number(0));
  for (std::size_t k = 1; k < corners.size(); ++k) {
    auto& row = rows[k - 1];
    row[3] =
        Number(corners[0].radius) * Number(corners[0].radius) - Number(corners[k].radius) * Number(corners[k].radius);
    for (int i = 0; i < 3; ++i) {
      const Number edge = Number(corners[k].position[i]) - Number(corners[0].position[i]);
      row[std::size_t(i)] = 2 * edge;
      row[3] += edge * edge;
    }
  }
  if (corners.size() == 3) rows[2][2] = Number(1);
  return rows;
}

template <class Number>
std::array<Number, 3> solved(const Rows<Number>& rows, const Number& whole) {
  return {determinant(rows, 3, 1, 2) / whole, determinant(rows, 0, 3, 2) / whole, determinant(rows, 0, 1, 3) / whole};
}

}  // namespace

Simplex canonical(Simplex corners) {
  Simplex least;
  for (const Corner& base : corners) {
    Simplex shifted = corners;
    for (Corner& corner : shifted)
      for (std::size_t k = 0; k < 3; ++k) corner.image[k] -= base.image[k];
    std::sort(shifted.begin(), shifted.end());
    if (least.empty() || shifted < least) least = shifted;
  }
  return least;
}

Copies copies_within(const PeriodicCell& cell, const std::vector<Ball>& balls, double margin) {
  Copies copies;
  copies.low = copies.high = balls.front().position;
  for (const Ball& ball : balls) {
    copies.low = copies.low.cwiseMin(ball.position);
    copies.high = copies.high.cwiseMax(ball.position);
    copies.largest_radius = std::max(copies.largest_radius, ball.radius);
  }
  copies.low -= Vector3::Constant(margin);
  copies.high += Vector3::Constant(margin);
  const Matrix3& lattice = cell.lattice;
  // The lattice is upper triangular: the last number moves all coordinates, the first only x.
  const auto range = [&](int k, double at) {
    return std::pair<int, int>(int(std::ceil((copies.low[k] - at) / lattice(k, k))),
                               int(std::floor((copies.high[k] - at) / lattice(k, k))));
  };
  for (std::size_t g = 0; g < balls.size(); ++g) {
    const Vector3& x = balls[g].position;
    const auto [z0, z1] = cell.dimension == 3 ? range(2, x[2]) : std::pair(0, 0);
    for (int nz = z0; nz <= z1; ++nz) {
      const auto [y0, y1] = range(1, x[1] + lattice(1, 2) * nz);
      for (int ny = y0; ny <= y1; ++ny) {
        const auto [x0, x1] = range(0, x[0] + lattice(0, 1) * ny + lattice(0, 2) * nz);
        for (int nx = x0; nx <= x1; ++nx) {
          const Image image{nx, ny, nz};
          copies.corners.push_back({int(g), image});
          copies.balls.push_back({x + cell.translation(image), balls[g].radius});
        }
      }
    }
  }
  return copies;
}

double beyond(const Copies& copies, int dimension, const Vector3& orthocentre, const Ball& corner) {
  // A copy at q of weight w is nearer than the corners if |q - c|^2 - w is below the power of the corners.
  const double reach = std::sqrt((corner.position - orthocentre).squaredNorm() +
                                 copies.largest_radius * copies.largest_radius - corner.radius * corner.radius);
  double most = -reach;
  for (int k = 0; k < dimension; ++k) {
    most = std::max(most, orthocentre[k] + reach - copies.high[k]);
    most = std::max(most, copies.low[k] - orthocentre[k] + reach);
  }
  return most;
}

Vector3 orthocentre_of(const std::vector<Ball>& corners) {
  const auto rows = equal_powers<double>(corners);
  double edges = 1;
  for (const auto& row : rows) edges *= std::hypot(row[0], row[1], row[2]);
  const double whole = determinant(rows, 0, 1, 2), flat = 1e-3;
  if (std::abs(whole) > flat * edges) {
    const auto c = solved(rows, whole);
    return corners[0].position + Vector3(c[0], c[1], c[2]);
  }
  using Exact = CGAL::Exact_rational;
  const auto exact = equal_powers<Exact>(corners);
  const auto c = solved<Exact>(exact, determinant(exact, 0, 1, 2));
  return corners[0].position + Vector3(CGAL::to_double(c[0]), CGAL::to_double(c[1]), CGAL::to_double(c[2]));
}

PowerCells power_cells(const PeriodicCell& cell, const std::vector<Ball>& balls) {
  if (balls.empty()) throw Error("no grains: there are no cells of grains; give a specimen that has some");
  const double spacing =
      std::pow(cell.volume() / (cell.dimension == 2 ? cell.lattice(2, 2) : 1) / balls.size(), 1.0 / cell.dimension);
  double margin = 3 * spacing;
  for (;;) {
    const Copies copies = copies_within(cell, balls, margin);
    Attempt attempt = cell.dimension == 2 ? attempt_in_plane(copies, balls.size(), cell.lattice(2, 2))
                                          : attempt_in_space(copies, balls.size());
    if (attempt.lacking <= 0) {
      auto& simplices = attempt.cells.simplices;
      std::sort(simplices.begin(), simplices.end());
      simplices.erase(std::unique(simplices.begin(), simplices.end()), simplices.end());
      attempt.cells.margin = margin;
      return attempt.cells;
    }
    margin += std::max(attempt.lacking, spacing) * 1.001;
  }
}

}  // namespace rvelab::voids
