// Power cells of discs.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_2.h>
#include <CGAL/Regular_triangulation_face_base_2.h>
#include <CGAL/Regular_triangulation_vertex_base_2.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <utility>

#include "tools/voids/power_cells.hpp"

namespace rvelab::voids {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertices =
    CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel, CGAL::Regular_triangulation_vertex_base_2<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<Vertices, CGAL::Regular_triangulation_face_base_2<Kernel>>;
using Triangulation = CGAL::Regular_triangulation_2<Kernel, Structure>;

Triangulation triangulation_of(const Copies& copies) {
  std::vector<std::pair<Kernel::Weighted_point_2, std::size_t>> points;
  for (std::size_t k = 0; k < copies.balls.size(); ++k) {
    const Ball& ball = copies.balls[k];
    points.emplace_back(Kernel::Weighted_point_2({ball.position[0], ball.position[1]}, ball.radius * ball.radius), k);
  }
  Triangulation triangulation;
  triangulation.insert(points.begin(), points.end());
  return triangulation;
}

double cross(const Vector3& a, const Vector3& b) { return a[0] * b[1] - a[1] * b[0]; }

}  // namespace

Attempt attempt_in_plane(const Copies& copies, std::size_t balls, double thickness) {
  const Triangulation triangulation = triangulation_of(copies);
  Attempt attempt;
  attempt.cells.volume.assign(balls, 0);
  if (triangulation.dimension() < 2) return {{}, 1e-300};
  for (const Triangulation::Vertex_handle vertex : triangulation.finite_vertex_handles()) {
    const Corner& corner = copies.corners[vertex->info()];
    if (corner.image != Image{}) continue;
    const Ball& ball = copies.balls[vertex->info()];
    std::vector<Vector3> polygon;  // of the orthocentres around, from the ball's centre
    auto face = triangulation.incident_faces(vertex), first = face;
    do {
      if (triangulation.is_infinite(face)) return {{}, 1e-300};
      Simplex simplex;
      std::vector<Ball> corners;
      for (int k = 0; k < 3; ++k) {
        simplex.push_back(copies.corners[face->vertex(k)->info()]);
        corners.push_back(copies.balls[face->vertex(k)->info()]);
      }
      const Vector3 centre = orthocentre_of(corners);
      attempt.lacking = std::max(attempt.lacking, beyond(copies, 2, centre, ball));
      attempt.cells.simplices.push_back(canonical(std::move(simplex)));
      polygon.push_back(centre - ball.position);
    } while (++face != first);
    double area = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) area += 0.5 * cross(polygon[k], polygon[(k + 1) % polygon.size()]);
    attempt.cells.volume[std::size_t(corner.ball)] = area * thickness;
  }
  return attempt;
}

}  // namespace rvelab::voids
