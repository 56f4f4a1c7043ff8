// Power cells of spheres.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_data_structure_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <Eigen/Geometry>
#include <iterator>
#include <optional>
#include <utility>

#include "tools/voids/power_cells.hpp"

namespace rvelab::voids {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertices =
    CGAL::Triangulation_vertex_base_with_info_3<std::size_t, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
/// Each cell stores its orthocentre at the first request.
using Cells = CGAL::Triangulation_cell_base_with_info_3<std::optional<Vector3>, Kernel,
                                                        CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_3<Vertices, Cells>;
using Triangulation = CGAL::Regular_triangulation_3<Kernel, Structure>;

Triangulation triangulation_of(const Copies& copies) {
  std::vector<std::pair<Kernel::Weighted_point_3, std::size_t>> points;
  for (std::size_t k = 0; k < copies.balls.size(); ++k) {
    const auto& [x, radius] = copies.balls[k];
    points.emplace_back(Kernel::Weighted_point_3({x[0], x[1], x[2]}, radius * radius), k);
  }
  Triangulation triangulation;
  triangulation.insert(points.begin(), points.end());
  return triangulation;
}

Vector3 orthocentre(const Copies& copies, Triangulation::Cell_handle cell) {
  if (!cell->info()) {
    std::vector<Ball> corners;
    for (int k = 0; k < 4; ++k) corners.push_back(copies.balls[cell->vertex(k)->info()]);
    cell->info() = orthocentre_of(corners);
  }
  return *cell->info();
}

/// Volume between the centre of a ball and the face that it shares with `other`, whose corners, the orthocentres around
/// their edge, are relative to the ball's centre; negative if the centre lies beyond the face.
double cone(const std::vector<Vector3>& face, const Vector3& towards_other) {
  Vector3 area = Vector3::Zero();
  double volume = 0;
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Vector3 turn = face[k].cross(face[(k + 1) % face.size()]);
    area += turn;
    volume += face[0].dot(turn) / 6;
  }
  return area.dot(towards_other) < 0 ? -volume : volume;
}

}  // namespace

Attempt attempt_in_space(const Copies& copies, std::size_t balls) {
  const Triangulation triangulation = triangulation_of(copies);
  Attempt attempt;
  attempt.cells.volume.assign(balls, 0);
  if (triangulation.dimension() < 3) return {{}, 1e-300};
  for (const Triangulation::Vertex_handle vertex : triangulation.finite_vertex_handles()) {
    const Corner& corner = copies.corners[vertex->info()];
    if (corner.image != Image{}) continue;
    const Ball& ball = copies.balls[vertex->info()];
    std::vector<Triangulation::Cell_handle> around;
    triangulation.incident_cells(vertex, std::back_inserter(around));
    for (const auto cell : around) {
      if (triangulation.is_infinite(cell)) return {{}, 1e-300};
      Simplex simplex;
      for (int k = 0; k < 4; ++k) simplex.push_back(copies.corners[cell->vertex(k)->info()]);
      attempt.lacking = std::max(attempt.lacking, beyond(copies, 3, orthocentre(copies, cell), ball));
      attempt.cells.simplices.push_back(canonical(std::move(simplex)));
    }
    std::vector<Triangulation::Edge> edges;
    triangulation.finite_incident_edges(vertex, std::back_inserter(edges));
    double& volume = attempt.cells.volume[std::size_t(corner.ball)];
    for (const auto& edge : edges) {
      const auto one = edge.first->vertex(edge.second), two = edge.first->vertex(edge.third);
      std::vector<Vector3> face;
      auto cell = triangulation.incident_cells(edge), first = cell;
      do face.push_back(orthocentre(copies, cell) - ball.position);
      while (++cell != first);
      volume += cone(face, copies.balls[(one == vertex ? two : one)->info()].position - ball.position);
    }
  }
  return attempt;
}

}  // namespace rvelab::voids
