// Points of the surface of a shape, spread evenly. A superquadric is laid out on the faces of the box around it, along
// the rays from the centre: where it is blocky its own faces, edges and corners are nearly those. Declared in
// shape.hpp.
#include <numbers>

#include "tools/mpm/shapes/polyhedron.hpp"
#include "tools/mpm/shapes/shape.hpp"
#include "tools/mpm/shapes/superquadric.hpp"

namespace mpm {
namespace {

template <int D>
using Visit = std::function<void(const Vec<D>&, const Vec<D>&, double)>;

long count_of(double whole, double each, double least) {
  return std::lround(std::min(1e9, std::max(least, whole / each)));
}

/// Equal parts of a circle, or a spiral on a sphere, whose turns all have the same area.
template <int D>
void sphere_points(double radius, double spacing, const Visit<D>& visit) {
  const double whole = D == 2 ? 2 * std::numbers::pi * radius : 4 * std::numbers::pi * radius * radius;
  const long count = count_of(whole, std::pow(spacing, D - 1), 6);
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (long k = 0; k < count; ++k) {
    Vec<D> normal;
    if constexpr (D == 2) {
      const double angle = 2 * std::numbers::pi * (double(k) + 0.5) / double(count);
      normal << std::cos(angle), std::sin(angle);
    } else {
      const double z = 1 - (2 * double(k) + 1) / double(count), around = std::sqrt(1 - z * z);
      normal << around * std::cos(golden * double(k)), around * std::sin(golden * double(k)), z;
    }
    visit(radius * normal, normal, whole / double(count));
  }
}

/// A face of the box around a superquadric: u from -1 to 1 along its other axes.
template <int D>
struct BoxFace {
  const Superquadric<D>& form;
  int axis;
  double side;

  Vec<D> place(const Eigen::Matrix<double, D - 1, 1>& u) const {
    Vec<D> x = Vec<D>::Unit(axis) * (side * form.half[axis]);
    for (int k = 1; k < D; ++k) x[(axis + k) % D] = u[k - 1] * form.half[(axis + k) % D];
    return form.retract(x);
  }

  /// Cuts the middle line of the face, along its k-th axis, in an even number of parts of one length, two of them
  /// about a spacing long: the values of u, and the length of the line.
  std::vector<double> cut(int k, double spacing, double& length) const {
    constexpr int fine = 2000;
    const auto at = [&](int m) {
      Eigen::Matrix<double, D - 1, 1> u = Eigen::Matrix<double, D - 1, 1>::Zero();
      u[k] = 2.0 * m / fine - 1;
      return place(u);
    };
    std::vector<double> along(fine + 1, 0.0);
    for (int m = 1; m <= fine; ++m) along[std::size_t(m)] = along[std::size_t(m) - 1] + (at(m) - at(m - 1)).norm();
    length = along.back();
    const long parts = 2 * count_of(length, spacing, 1);
    std::vector<double> cuts = {-1};
    for (long part = 1, m = 0; part < parts; ++part) {
      const double reached = length * double(part) / double(parts);
      while (along[std::size_t(m) + 1] < reached) ++m;
      const double share = (reached - along[std::size_t(m)]) / (along[std::size_t(m) + 1] - along[std::size_t(m)]);
      cuts.push_back(2 * (double(m) + share) / fine - 1);
    }
    cuts.push_back(1);
    return cuts;
  }
};

void superquadric_points(const Superquadric<2>& form, double spacing, const Visit<2>& visit) {
  for (int face = 0; face < 4; ++face) {
    const BoxFace<2> side{form, face / 2, face % 2 ? 1.0 : -1.0};
    double length = 0;
    const std::vector<double> cuts = side.cut(0, spacing, length);
    for (std::size_t k = 1; k < cuts.size(); k += 2) {
      const Vec<2> place = side.place(Eigen::Matrix<double, 1, 1>(cuts[k]));
      visit(place, form.normal(place), 2 * length / double(cuts.size() - 1));
    }
  }
}

/// The area over a part of a face, by 4 x 4 flat pieces.
double patch_area(const BoxFace<3>& face, const Vec<2>& low, const Vec<2>& high) {
  constexpr int pieces = 4;
  std::array<std::array<Vec<3>, pieces + 1>, pieces + 1> nodes;
  for (int i = 0; i <= pieces; ++i) {
    for (int j = 0; j <= pieces; ++j) {
      const Vec<2> share(double(i) / pieces, double(j) / pieces);
      nodes[std::size_t(i)][std::size_t(j)] = face.place(low + share.cwiseProduct(high - low));
    }
  }
  double area = 0;
  for (std::size_t i = 0; i < pieces; ++i) {
    for (std::size_t j = 0; j < pieces; ++j) {
      const Vec<3> diagonal = nodes[i + 1][j + 1] - nodes[i][j], other = nodes[i][j + 1] - nodes[i + 1][j];
      area += 0.5 * diagonal.cross(other).norm();
    }
  }
  return area;
}

void superquadric_points(const Superquadric<3>& form, double spacing, const Visit<3>& visit) {
  for (int number = 0; number < 6; ++number) {
    const BoxFace<3> face{form, number / 2, number % 2 ? 1.0 : -1.0};
    double length = 0;
    const std::vector<double> u = face.cut(0, spacing, length), v = face.cut(1, spacing, length);
    for (std::size_t i = 1; i < u.size(); i += 2) {
      for (std::size_t j = 1; j < v.size(); j += 2) {
        const Vec<3> place = face.place({u[i], v[j]});
        const double area = patch_area(face, {u[i - 1], v[j - 1]}, {u[i + 1], v[j + 1]});
        visit(place, form.normal(place), area);
      }
    }
  }
}

/// Halves the longest edge of a triangle until it has about the area spacing^2 and is not long.
void triangle_points(const Triangle& triangle, const Vec<3>& normal, double spacing, const Visit<3>& visit) {
  std::size_t longest = 0;
  double length = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double edge = (triangle[(k + 1) % 3] - triangle[k]).norm();
    if (edge <= length * (1 + 1e-9)) continue;
    longest = k;
    length = edge;
  }
  const Vec<3>&first = triangle[longest], &second = triangle[(longest + 1) % 3], &third = triangle[(longest + 2) % 3];
  const double area = 0.5 * (second - first).cross(third - first).norm();
  if (length <= 2.5 * spacing && area <= 1.4 * spacing * spacing) {
    visit((first + second + third) / 3, normal, area);
    return;
  }
  const Vec<3> middle = 0.5 * (first + second);
  triangle_points({first, middle, third}, normal, spacing, visit);
  triangle_points({middle, second, third}, normal, spacing, visit);
}

}  // namespace

template <int D>
void RockShape<D>::each_surface_point(double spacing, const Visit<D>& visit) const {
  if (!(spacing > 0)) throw InputError("the spacing of the points on a rock's surface must be positive");
  if (const double* radius = std::get_if<0>(&form_)) return sphere_points<D>(*radius, spacing, visit);
  if (const auto* form = std::get_if<1>(&form_)) return superquadric_points(**form, spacing, visit);
  if constexpr (D == 3) {
    const Polyhedron& body = *std::get<2>(form_);
    for (const auto& face : body.faces) {
      for (const int k : face.triangles) triangle_points(body.triangle(k), face.normal, spacing, visit);
    }
  }
}

template void RockShape<2>::each_surface_point(double, const Visit<2>&) const;
template void RockShape<3>::each_surface_point(double, const Visit<3>&) const;

}  // namespace mpm
