#include "tools/mpm/shapes/polyhedron.hpp"

#include <algorithm>
#include <map>

#include "tools/mpm/error.hpp"

namespace mpm {
namespace {

constexpr double flatness = 1e-6;  ///< of its size, how far a corner may lie in front of a face
constexpr const char* mesh_remedy = "; repair the mesh, or take its convex hull";

Vec<3> area_of(const Triangle& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]); }

/// The triangle on the left of each directed side.
using Sides = std::map<std::pair<int, int>, int>;

Sides sides_of(const Polyhedron& form) {
  Sides sides;
  for (std::size_t t = 0; t < form.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) sides[{form.triangles[t][k], form.triangles[t][(k + 1) % 3]}] = int(t);
  }
  return sides;
}

/// Triangles whose normals differ by less than 1e-5 are one face.
void find_faces(Polyhedron& form, const Sides& sides) {
  std::vector<Vec<3>> normals;
  for (std::size_t k = 0; k < form.triangles.size(); ++k)
    normals.push_back(area_of(form.triangle(int(k))).normalized());
  std::vector<int> face_of(form.triangles.size(), -1);
  for (std::size_t start = 0; start < form.triangles.size(); ++start) {
    if (face_of[start] >= 0) continue;
    Polyhedron::Face face{Vec<3>::Zero(), 0, {int(start)}};
    face_of[start] = int(form.faces.size());
    for (std::size_t next = 0; next < face.triangles.size(); ++next) {
      const int t = face.triangles[next];
      face.normal += area_of(form.triangle(t));
      const auto& numbers = form.triangles[std::size_t(t)];
      for (std::size_t k = 0; k < 3; ++k) {
        const int other = sides.at({numbers[(k + 1) % 3], numbers[k]});
        if (face_of[std::size_t(other)] >= 0) continue;
        if ((normals[std::size_t(other)] - normals[start]).norm() > 1e-5) continue;
        face_of[std::size_t(other)] = int(form.faces.size());
        face.triangles.push_back(other);
      }
    }
    face.normal.normalize();
    form.faces.push_back(face);
  }
  for (const auto& [side, triangle] : sides) {
    const int left = face_of[std::size_t(triangle)];
    const int right = face_of[std::size_t(sides.at({side.second, side.first}))];
    if (side.first < side.second && left != right) form.edges.push_back({{side.first, side.second}, {left, right}});
  }
}

/// Each face is laid through the corner farthest out, so that height and faces agree.
void check_convex(Polyhedron& form) {
  const double size = form.size();
  for (Polyhedron::Face& face : form.faces) {
    face.height = form.height(face.normal);
    for (const int t : face.triangles) {
      for (const Vec<3>& corner : form.triangle(t)) {
        if (face.normal.dot(corner) >= face.height - flatness * size) continue;
        throw InputError("the surface is not convex: a corner lies " + in_words(face.height - face.normal.dot(corner)) +
                         " m in front of a face, at most 1e-6 of the size is allowed; take its convex hull, or cut it "
                         "into convex pieces");
      }
    }
  }
}

/// The columns are the principal axes, as near to the axes of the triangles as they can be.
Mat<3> principal_axes(Mat<3> inertia) {
  const double noise = 1e-12 * inertia.trace();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (i != j && std::abs(inertia(i, j)) < noise) inertia(i, j) = 0;
    }
  }
  const Mat<3> found = Eigen::SelfAdjointEigenSolver<Mat<3>>(inertia).eigenvectors();
  Mat<3> best = Mat<3>::Identity();
  double nearest = -1e300;
  int order[3] = {0, 1, 2};
  do {
    Mat<3> axes;
    for (int i = 0; i < 3; ++i) axes.col(i) = (found(i, order[i]) < 0 ? -1 : 1) * found.col(order[i]);
    if (axes.determinant() < 0) {  // the axis that is farthest from its own is turned round
      int least = 0;
      axes.diagonal().minCoeff(&least);
      axes.col(least) *= -1;
    }
    if (axes.trace() <= nearest + 1e-9) continue;
    nearest = axes.trace();
    best = axes;
  } while (std::next_permutation(order, order + 3));
  return best;
}

}  // namespace

Solid solid_of(const std::vector<Triangle>& triangles) {
  Solid solid;
  Polyhedron& form = solid.form;
  static_cast<rvelab::Mesh&>(form) = rvelab::mesh_of(triangles, "its surface");
  Vec<3> middle = Vec<3>::Zero();
  for (const Vec<3>& corner : form.corners) middle += corner / double(form.corners.size());
  const auto body = rvelab::properties_of(form, middle);
  const double size = form.size();
  if (!(body.volume > 1e-9 * size * size * size))
    throw InputError(std::string("its surface holds no volume") + mesh_remedy);
  for (std::size_t k = 0; k < form.triangles.size(); ++k) {
    if (area_of(form.triangle(int(k))).norm() > 1e-9 * size * size) continue;
    throw InputError(std::string("a triangle of the surface has no area, its corners lie on a line") + mesh_remedy);
  }
  const Mat<3> axes = principal_axes(body.inertia);
  for (Vec<3>& corner : form.corners) corner = (axes.transpose() * (corner - body.centre)).eval();
  solid.volume = body.volume;
  solid.inertia = (axes.transpose() * body.inertia * axes).diagonal();
  solid.centre = body.centre;
  solid.orientation = Eigen::Quaterniond(axes).normalized();
  find_faces(form, sides_of(form));
  check_convex(form);
  return solid;
}

int Polyhedron::corner_along(const Vec<3>& direction) const {
  int found = 0;
  double farthest = -1e300;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const double far = corners[k].dot(direction);
    if (far <= farthest) continue;
    farthest = far;
    found = int(k);
  }
  return found;
}

Triangle Polyhedron::triangle(int k) const {
  const auto& numbers = triangles[std::size_t(k)];
  return {corner(numbers[0]), corner(numbers[1]), corner(numbers[2])};
}

double Polyhedron::size() const {
  Vec<3> low = Vec<3>::Constant(1e300), high = Vec<3>::Constant(-1e300);
  for (const Vec<3>& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  return corners.empty() ? 0 : (high - low).maxCoeff();
}

Vec<3> nearest_of_segment(const Vec<3>& first, const Vec<3>& second, const Vec<3>& r) {
  const Vec<3> along = second - first;
  return first + std::clamp((r - first).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
}

double Polyhedron::distance(const Vec<3>& r, Vec<3>& outward) const {
  double beyond = -1e300, nearest = 1e300;
  for (const Face& face : faces) {
    const double here = face.normal.dot(r) - face.height;
    if (here <= beyond) continue;
    beyond = here;
    outward = face.normal;
  }
  if (beyond <= 0) return beyond;
  Vec<3> away = outward;
  for (const Face& face : faces) {
    const double here = face.normal.dot(r) - face.height;
    if (!(here > 0) || here >= nearest) continue;
    for (const int number : face.triangles) {
      const Triangle t = triangle(number);
      bool above = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec<3>&first = t[k], &second = t[(k + 1) % 3];
        if (face.normal.dot((second - first).cross(r - first)) >= 0) continue;
        above = false;
        const Vec<3> to = r - nearest_of_segment(first, second, r);
        if (to.norm() >= nearest) continue;
        nearest = to.norm();
        away = to;
      }
      if (!above || here >= nearest) continue;
      nearest = here;
      away = here * face.normal;
    }
  }
  if (nearest > 1e-9 * size()) outward = away.normalized();  // else the normal of the face that it is beyond
  return nearest;
}

}  // namespace mpm
