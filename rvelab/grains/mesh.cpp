#include "rvelab/grains/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>

#include "rvelab/error.hpp"

namespace rvelab {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t head_of_binary = 84, size_of_triangle = 50;

/// Number of triangles if these are the bytes of a binary STL, else -1. Binary ones may begin with "solid" too.
long count_in_binary(const std::string& bytes) {
  if (bytes.size() < head_of_binary) return -1;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return bytes.size() == head_of_binary + size_of_triangle * std::size_t(count) ? long(count) : -1;
}

std::vector<Triangle> triangles_of_binary(const std::string& bytes, long count) {
  std::vector<Triangle> triangles;
  for (long t = 0; t < count; ++t) {
    float values[12];  // a normal, which follows from the corners, and these
    std::memcpy(values, bytes.data() + head_of_binary + size_of_triangle * std::size_t(t), sizeof values);
    auto& triangle = triangles.emplace_back();
    for (int c = 0; c < 3; ++c) triangle[std::size_t(c)] = {values[3 * c + 3], values[3 * c + 4], values[3 * c + 5]};
  }
  return triangles;
}

std::vector<Triangle> triangles_of_text(const std::string& bytes, const std::string& where) {
  const auto damaged = [&](const std::string& what) {
    throw InputError(where + ": " + what + "; the file is cut off or damaged; export it again");
  };
  std::istringstream in(bytes);
  std::string word, name;
  std::vector<Triangle> triangles;
  std::size_t corners = 3;  // of the facet
  bool ended = false;
  while (in >> word) {
    if (word == "solid" || word == "endsolid") {
      std::getline(in, name);  // it may have any words
      ended = word == "endsolid";
    } else if (word == "facet") {
      triangles.emplace_back();
      corners = 0;
    } else if (word == "vertex") {
      if (corners == 3) damaged("a facet has more than three corners, or a corner lies outside of facets");
      for (double& x : triangles.back()[corners])
        if (!(in >> x)) damaged("a corner of facet " + std::to_string(triangles.size()) + " has no three numbers");
      ++corners;
    } else if (word == "endfacet" && corners != 3) {
      damaged("facet " + std::to_string(triangles.size()) + " has " + std::to_string(corners) + " corners");
    }
  }
  if (!ended) damaged("its last line, endsolid, is missing");
  return triangles;
}

/// Corners at one place become one; triangles without area go.
Mesh joined(const std::vector<Triangle>& triangles, const std::string& where) {
  Vector3d low = triangles.front()[0], high = low;
  for (const Triangle& triangle : triangles)
    for (const Vector3d& x : triangle) {
      if (!x.allFinite()) throw InputError(where + ": a corner is not finite; export the surface again");
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
  const double grid = 1e-6 * (high - low).maxCoeff();
  if (!(grid > 0)) throw InputError(where + ": all corners lie at one place; export the surface again");
  Mesh mesh;
  std::map<std::array<std::int64_t, 3>, int> known;
  for (const Triangle& triangle : triangles) {
    std::array<int, 3> index{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Vector3d& x = triangle[c];
      std::array<std::int64_t, 3> at{};
      for (int k = 0; k < 3; ++k) at[std::size_t(k)] = std::int64_t(std::floor((x[k] - low[k]) / grid + 0.5));
      const auto [place, is_new] = known.emplace(at, int(mesh.corners.size()));
      if (is_new) mesh.corners.push_back(x);
      index[c] = place->second;
    }
    if (index[0] != index[1] && index[1] != index[2] && index[2] != index[0]) mesh.triangles.push_back(index);
  }
  return mesh;
}

/// Each edge belongs to two triangles, which run along it in opposite ways.
void expect_closed(const Mesh& mesh, const std::string& where) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  std::size_t open = 0, turned = 0;
  for (const auto& [edge, times] : edges) {
    turned += times > 1;
    open += times == 1 && !edges.contains({edge.second, edge.first});
  }
  if (open == 0 && turned == 0) return;
  throw InputError(where + ": its surface is not closed (" + std::to_string(std::max(open, turned)) + " of " +
                   std::to_string(edges.size()) + " edges " +
                   (open > 0 ? "belong to one triangle alone" : "lie between triangles that are turned differently") +
                   "); fill its holes and make its normals agree, in the program that it comes from");
}

/// The nearest point of a triangle (Ericson 2005, 5.1.5).
Vector3d nearest_in(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

}  // namespace

Mesh mesh_of(const std::vector<Triangle>& triangles, const std::string& where) {
  if (triangles.size() < 4)
    throw InputError(where + ": it has " + std::to_string(triangles.size()) +
                     " triangles; a closed surface has four or more; export it again");
  Mesh mesh = joined(triangles, where);
  expect_closed(mesh, where);
  double volume = properties_of(mesh).volume;
  if (volume < 0) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    volume = -volume;
  }
  if (!(volume > 0)) throw InputError(where + ": its surface holds no volume; export the surface of a body");
  return mesh;
}

Mesh read_stl(const std::string& bytes, const std::string& where) {
  if (const long count = count_in_binary(bytes); count >= 0) return mesh_of(triangles_of_binary(bytes, count), where);
  std::istringstream in(bytes);
  if (std::string first; !(in >> first) || first != "solid")
    throw InputError(where +
                     ": it is no STL file (neither \"solid\" nor a binary one of the size that it names); "
                     "export the surface of the body as STL");
  return mesh_of(triangles_of_text(bytes, where), where);
}

MassProperties properties_of(const Mesh& mesh) {
  return properties_of(mesh, mesh.corners[std::size_t(mesh.triangles.front()[0])]);
}

MassProperties properties_of(const Mesh& mesh, const Vector3d& from) {
  MassProperties p;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();  // integral of x x^T
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.corners[std::size_t(t[0])] - from, b = mesh.corners[std::size_t(t[1])] - from,
                   c = mesh.corners[std::size_t(t[2])] - from, sum = a + b + c;
    const double six_volumes = a.dot(b.cross(c));
    p.volume += six_volumes / 6;
    first += six_volumes / 24 * sum;
    second += six_volumes / 120 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (p.volume == 0) return p;
  const Vector3d centre = first / p.volume;
  p.centre = from + centre;
  second -= p.volume * centre * centre.transpose();
  p.inertia = second.trace() * Matrix3d::Identity() - second;
  return p;
}

double distance_to(const Mesh& mesh, const Vector3d& point, double farthest) {
  double least = farthest;
  for (const auto& t : mesh.triangles) {
    const Vector3d &a = mesh.corners[std::size_t(t[0])], &b = mesh.corners[std::size_t(t[1])],
                   &c = mesh.corners[std::size_t(t[2])];
    // Outside of the box of the triangle by more than the least so far.
    bool far = false;
    for (int k = 0; k < 3 && !far; ++k)
      far = point[k] < std::min({a[k], b[k], c[k]}) - least || point[k] > std::max({a[k], b[k], c[k]}) + least;
    if (!far) least = std::min(least, (point - nearest_in(point, a, b, c)).norm());
  }
  return least;
}

}  // namespace rvelab
