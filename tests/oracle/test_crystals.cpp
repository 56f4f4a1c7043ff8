// Crystals: pressure and elastic tangent in closed form against central differences of apply and relax.
//
// A site of a crystal is a centre of symmetry: under a homogeneous strain no grain leaves the affine motion, and under
// a symmetric one of these lattices no grain turns. With dH symmetric, bonds b = l n and F = f n at the start,
//   dF = -kn (n.e b) n + f (e n - n (n.e n)) - kt (e b - n (n.e b)),  db = e b,
//   d sigma = -(1/V) sum (dF (x) b + F (x) db) - sigma tr e.
// Limit of the differences: an overlap is known to one unit in the last place of the coordinates, 1e-16 cell lengths,
// and changes by about 1e-6 spacings: a few 1e-10. Truncation of central differences is the square of strain over
// overlap ratio for a Hertz contact; Richardson's combination of two sizes takes it out. Where a Hertz-Mindlin contact
// rescales its tangential force on unloading, the second order differs between the two directions and the error is
// linear in the strain: the two sizes are then combined to take that out, at a smaller strain.
#include "tests/specimens.hpp"

#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

constexpr double spacing = 0.01;

/// side x side discs of diameter d on the lattice with a = (l, 0), b given in units of l.
Specimen lattice_of_discs(int side, double bx, double by, double diameter, double kn, double kt) {
  Specimen s = empty_specimen(Shape::disc, 1, linear_material(kn, kt, 1e6));
  s.cell.lattice << side * spacing, side * bx * spacing, 0, 0, side * by * spacing, 0, 0, 0, 0.1;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) add_grain(s, Vector3(i + bx * j, by * j, 0) * spacing, 0.5 * diameter);
  return s;
}

/// Spheres on the face-centred cubic lattice, 4 side^3 of them, neighbours at l = spacing.
Specimen face_centred(int side, double diameter, const Material& material, Law law) {
  const double edge = std::sqrt(2.0) * spacing;
  Specimen s = empty_specimen(Shape::sphere, side * edge, material, law);
  for (int k = 0; k < 2 * side; ++k)
    for (int j = 0; j < 2 * side; ++j)
      for (int i = 0; i < 2 * side; ++i)
        if ((i + j + k) % 2 == 0) add_grain(s, 0.5 * edge * Vector3(i + 0.1, j + 0.2, k + 0.3), 0.5 * diameter);
  return s;
}

Matrix3 unit_strain(int component, int dimension) {
  static const int axes[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  const int* a = axes[dimension == 2 && component == 2 ? 5 : component];
  Matrix3 e = Matrix3::Zero();
  e(a[0], a[1]) += 0.5;
  e(a[1], a[0]) += 0.5;
  return e;
}

Eigen::VectorXd components(const Matrix3& s, int dimension) {
  Eigen::VectorXd v(dimension == 2 ? 3 : 6);
  if (dimension == 2)
    v << s(0, 0), s(1, 1), 0.5 * (s(0, 1) + s(1, 0));
  else
    v << s(0, 0), s(1, 1), s(2, 2), 0.5 * (s(1, 2) + s(2, 1)), 0.5 * (s(0, 2) + s(2, 0)), 0.5 * (s(0, 1) + s(1, 0));
  return v;
}

/// The closed form at the head of this file for bonds n_k (each counted once), cell volume V.
Eigen::MatrixXd bond_tangent(const std::vector<Vector3>& normals, double volume, double l, double f, double kn,
                             double kt, int dimension) {
  const int n = dimension == 2 ? 3 : 6;
  Matrix3 stress = Matrix3::Zero();
  for (const Vector3& normal : normals) stress -= f * l / volume * normal * normal.transpose();
  Eigen::MatrixXd c(n, n);
  for (int k = 0; k < n; ++k) {
    const Matrix3 e = unit_strain(k, dimension);
    Matrix3 change = -stress * e.trace();
    for (const Vector3& normal : normals) {
      const Vector3 b = l * normal, en = e * normal, turned = en - normal * normal.dot(en);
      const Vector3 df = -kn * normal.dot(e * b) * normal + f * turned - kt * l * turned;
      change -= (df * b.transpose() + f * normal * (e * b).transpose()) / volume;
    }
    c.col(k) = components(change, dimension);
  }
  return c;
}

/// Central differences of apply and relax at two sizes, combined so that an error of the given order drops out.
Eigen::MatrixXd differences(const Rve& rve, double size, int order = 2) {
  const int dimension = rve.cell().dimension, n = dimension == 2 ? 3 : 6;
  const auto at = [&](double strain, int k) {
    Rve copy(rve);
    copy.apply(strain * unit_strain(k, dimension), 0);
    copy.relax(1e-13, 20000);
    return components(copy.stress(), dimension);
  };
  Eigen::MatrixXd c(n, n);
  for (int k = 0; k < n; ++k) {
    const Eigen::VectorXd narrow = (at(size, k) - at(-size, k)) / (2 * size);
    const Eigen::VectorXd wide = (at(2 * size, k) - at(-2 * size, k)) / (4 * size);
    c.col(k) = order == 2 ? Eigen::VectorXd((4 * narrow - wide) / 3) : Eigen::VectorXd(2 * narrow - wide);
  }
  return c;
}

double relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a triangular crystal has p = sqrt3 kn (d/l - 1), K = sqrt3/2 kn d/l and G = sqrt3/4 (kn + kt - 3 f/l)") {
  const int side = GENERATE(1, 4, 7);  // 1: a grain that touches nothing but its own images
  const double ratio = GENERATE(1.001, 1.02), kn = 3e7, kt = 1.2e7;
  const double d = ratio * spacing, f = kn * (d - spacing), thickness = 0.1;
  Specimen s = lattice_of_discs(side, 0.5, std::sqrt(0.75), d, kn, kt);
  s.solver.min_height = 0.5 * spacing;
  const Rve rve(s);
  const double p = std::sqrt(3.0) * kn * (ratio - 1) / thickness;
  const Matrix3 expected = Vector3(-p, -p, 0).asDiagonal();
  CHECK(largest(rve.stress() - expected) < 1e-12 * p / (ratio - 1));  // overlaps carry the round-off of coordinates
  const double bulk = std::sqrt(0.75) * kn * ratio / thickness;
  const double shear = std::sqrt(3.0) / 4 * (kn + kt - 3 * f / spacing) / thickness;
  // sigma = -p I at the start: a Cauchy tangent with these initial-stress terms is isotropic as it stands.
  Eigen::MatrixXd c(3, 3);
  c << bulk + shear, bulk - shear, 0, bulk - shear, bulk + shear, 0, 0, 0, shear;
  std::vector<Vector3> normals;
  for (int k = 0; k < 3; ++k) normals.push_back({std::cos(k * pi / 3), std::sin(k * pi / 3), 0});
  const double volume = std::sqrt(0.75) * spacing * spacing * thickness;
  CHECK(relative_difference(bond_tangent(normals, volume, spacing, f, kn, kt, 2), c) < 1e-13);
  const double found = relative_difference(differences(rve, 1e-5), c);
  INFO("difference " << found);
  CHECK(found < 1e-8);
  CHECK(relative_difference(elastic_tangent(rve.network()), c) < 1e-10);
}

TEST_CASE("a square crystal has C11 = kn, C12 = f/l and C66 = kt/2 - f/l") {
  const double ratio = GENERATE(1.0001, 1.01), kn = 3e7, kt = 1.2e7, thickness = 0.1;
  const double d = ratio * spacing, f = kn * (d - spacing);
  const Rve rve(lattice_of_discs(5, 0, 1, d, kn, kt));
  // Of its own accord f -> 0 gives kn, 0, kt/2.
  Eigen::MatrixXd c(3, 3);
  c << kn, f / spacing, 0, f / spacing, kn, 0, 0, 0, kt / 2 - f / spacing;
  c /= thickness;
  const double volume = spacing * spacing * thickness;
  CHECK(relative_difference(bond_tangent({Vector3::UnitX(), Vector3::UnitY()}, volume, spacing, f, kn, kt, 2), c) <
        1e-13);
  const double found = relative_difference(differences(rve, 1e-6 * std::min(1.0, 1e4 * (ratio - 1))), c);
  INFO("difference " << found);
  CHECK(found < 1e-8);
  CHECK(relative_difference(elastic_tangent(rve.network()), c) < 1e-10);
}

TEST_CASE("a face-centred crystal of spheres has the tangent of its bonds, linear, Hertz-Mindlin, rough and of cones") {
  const Law law = GENERATE(Law::linear_stiffness, Law::hertz_mindlin, Law::hertz_rough, Law::cones);
  const bool unload_rescale = GENERATE(false, true);
  const double ratio = 1.01, d = ratio * spacing, overlap = d - spacing;
  Material m = linear_material(3e5, 1.2e5, 1e6);
  m.young_modulus = 7e7;
  m.poisson_ratio = 0.2;
  double f = 3e5 * overlap, kn = 3e5, kt = 1.2e5;
  const double plane = 0.5 * 7e7 / (1 - 0.04), mindlin = 2 * 0.8 / 1.8;
  if (law == Law::cones) {
    m.cone_slope = 0.05;
    f = 2 * plane / (pi * 0.1) * overlap * overlap;
    kn = 2 * f / overlap;
    kt = mindlin * kn;
  }
  if (law == Law::hertz_rough) {  // in the second regime, which ends at 24.467 S: stiffness and force there
    m.roughness = 1e-5;
    const double s = std::sqrt(2.0) * 1e-5, offset = 0.82 * s, end = 24.467023732785824 * s, b = 1.5830096858101890;
    const double force = 100 * s * plane * std::sqrt(2 * 0.25 * d * s);
    f = force * std::pow((overlap - offset) / (end - offset), b);
    kn = b * f / (overlap - offset);
    kt = mindlin * kn;
  }
  if (law == Law::hertz_mindlin) {
    const double root = std::sqrt(0.25 * d * overlap);  // sqrt(r* delta), r* = d/4
    f = 4.0 / 3.0 * (0.5 * 7e7 / (1 - 0.04)) * root * overlap;
    kn = 1.5 * f / overlap;
    kt = 8 * (7e7 / (4 * 1.8 * 1.2)) * root;
  }
  Specimen specimen = face_centred(2, d, m, law);
  specimen.contact.unload_rescale = unload_rescale;
  const Rve rve(specimen);
  std::vector<Vector3> normals;
  for (int sign : {1, -1})
    for (int k = 0; k < 3; ++k) {
      Vector3 n = Vector3::Zero();
      n[k] = std::sqrt(0.5);
      n[(k + 1) % 3] = sign * std::sqrt(0.5);
      normals.push_back(n);
    }
  const double volume = spacing * spacing * spacing / std::sqrt(2.0), p = 2 * f * spacing / volume;
  CHECK(largest(rve.stress() + p * Matrix3::Identity()) < 1e-12 * p / (ratio - 1));
  const Eigen::MatrixXd c = bond_tangent(normals, volume, spacing, f, kn, kt, 3);
  const bool one_sided = law != Law::linear_stiffness && unload_rescale;
  const double found = relative_difference(one_sided ? differences(rve, 3e-7, 1) : differences(rve, 1e-5), c);
  INFO("difference " << found);
  CHECK(found < 1e-8);
  CHECK(relative_difference(elastic_tangent(rve.network()), c) < 1e-10);
}
