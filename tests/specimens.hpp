// Specimens and comparisons: a few grains in a large cell, crystals, disordered packings, the packings of tests/data.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>

#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"
#include "tests/reference_specimen.hpp"

namespace rvelab::test {

inline const double pi = std::acos(-1.0);

inline Material linear_material(double kn, double kt, double friction) {
  Material m;
  m.normal_stiffness = kn;
  m.tangential_stiffness = kt;
  m.friction = friction;
  return m;
}

/// With the parameters of every law, and of rolling.
inline Material material_of_every_law() {
  Material m = linear_material(2e6, 1e6, 0.4);
  m.young_modulus = 2e8;
  m.poisson_ratio = 0.2;
  m.roughness = 2e-5;
  m.cone_slope = 0.05;
  m.rolling_stiffness = 0.8;
  m.rolling_friction = 0.05;
  return m;
}

inline void add_grain(Specimen& s, const Vector3& position, double radius, int material = 0) {
  s.grains.id.push_back(std::int64_t(s.grains.size()) + 1);
  s.grains.radius.push_back(radius);
  s.grains.material.push_back(material);
  s.grains.position.push_back(position);
  s.grains.velocity.push_back(Vector3::Zero());
  s.grains.spin.push_back(Vector3::Zero());
}

/// Semi-axes a >= b (m), the long one at `angle` to x.
inline void add_ellipse(Specimen& s, const Vector3& position, double a, double b, double angle, int material = 0) {
  add_grain(s, position, std::sqrt(a * b), material);
  s.grains.semi_major.push_back(a);
  s.grains.semi_minor.push_back(b);
  s.grains.orientation.emplace_back(std::cos(angle), std::sin(angle), 0);
}

/// No grains yet: a square or cubic cell of the given edge, linear_stiffness contacts.
inline Specimen empty_specimen(Shape shape, double edge, const Material& material, Law law = Law::linear_stiffness) {
  Specimen s;
  s.shape = shape;
  s.cell.dimension = dimension_of(shape);
  s.cell.lattice = Vector3(edge, edge, dimension_of(shape) == 2 ? 1.0 : edge).asDiagonal();
  s.materials = {material};
  s.contact.law = law;
  return s;
}

/// A disordered packing of side^d grains: a crystal with its sites moved by up to `jitter` spacings and radii spread by
/// a tenth; not at rest yet. Fractions of the spacing throughout. Ellipses: of those areas, aspect 0.7 to 0.95, turned
/// anyhow.
inline Specimen disordered(Shape shape, int side, const Material& material, Law law, double radius_over_spacing,
                           std::uint64_t seed, double jitter = 0.05) {
  const double spacing = 0.01;
  Specimen s = empty_specimen(shape, side * spacing, material, law);
  if (dimension_of(shape) == 2) s.cell.lattice(2, 2) = spacing;
  s.solver.max_overlap_ratio = shape == Shape::ellipse ? 0.8 : 0.5;
  std::mt19937_64 generator(seed);
  const auto uniform = [&] { return 2 * double(generator() >> 11) / 9007199254740992.0 - 1; };
  const int depth = dimension_of(shape) == 2 ? 1 : side;
  for (int k = 0; k < depth; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        Vector3 x = Vector3(i, j, k) * spacing - 0.5 * (side - 1) * spacing * Vector3::Ones();
        for (int c = 0; c < s.cell.dimension; ++c) x[c] += jitter * spacing * uniform();
        if (dimension_of(shape) == 2) x[2] = 0;
        const double radius = radius_over_spacing * spacing * (1 + 0.05 * uniform());
        if (shape == Shape::ellipse) {
          const double root = std::sqrt(0.825 + 0.125 * uniform());
          add_ellipse(s, x, radius / root, radius * root, pi * uniform());
        } else {
          add_grain(s, x, radius);
        }
      }
  return s;
}

/// A disordered packing relaxed at dt = 0.
inline Rve at_rest(const Specimen& s, double unbalanced = 1e-10) {
  Rve rve(s);
  const Report report = rve.relax(unbalanced, 2'000'000);
  REQUIRE(report.target_held);
  return rve;
}

inline Matrix3 gradient(double xx, double xy, double yx, double yy) {
  Matrix3 g = Matrix3::Zero();
  g(0, 0) = xx;
  g(0, 1) = xy;
  g(1, 0) = yx;
  g(1, 1) = yy;
  return g;
}

inline Matrix3 rotation_about_z(double angle) { return Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix(); }

inline bool same_bits(const Matrix3& a, const Matrix3& b) {
  return std::memcmp(a.data(), b.data(), sizeof(Matrix3)) == 0;
}

inline double largest(const Matrix3& m) { return m.cwiseAbs().maxCoeff(); }

inline double pressure(const Matrix3& stress, int dimension) {
  return -(stress(0, 0) + stress(1, 1) + (dimension == 3 ? stress(2, 2) : 0.0)) / dimension;
}

}  // namespace rvelab::test
