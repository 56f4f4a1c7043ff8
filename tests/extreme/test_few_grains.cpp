// One, two and three grains: cells in which a grain touches its own images. Every grain of these cells but the chain's
// is a centre of symmetry, so that it stays in balance under any homogeneous deformation and the stress is that of the
// affinely moved grains, which a sum over images gives.
#include "tests/catch.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

Matrix3 random_gradient(Random& random, int dimension, double size) {
  Matrix3 gradient = Matrix3::Zero();
  for (int i = 0; i < dimension; ++i)
    for (int k = 0; k < dimension; ++k) gradient(i, k) = random(-size, size);
  return gradient;
}

/// Stress of the specimen after every point has moved by F = I + dH (frame at rest: rotation is the identity).
Matrix3 affine_stress(Specimen s, const Matrix3& gradient) {
  const Matrix3 f = Matrix3::Identity() + gradient;
  s.cell.lattice = (f * s.cell.lattice).eval();
  for (Vector3& x : s.grains.position) x = f * x;
  // The volume of a lattice that is not triangular is its determinant; stress_by_hand divides by the diagonal.
  const double volume = s.cell.lattice.determinant();
  return stress_by_hand(s) * (s.cell.volume() / volume);
}

/// Two grains, radii 1 and 0.8, one at the centre of the other's cell; they overlap by 0.08.
Specimen centred(int dimension) {
  const double side = (1.8 - 0.08) * 2 / std::sqrt(double(dimension));
  const double quarter = side / 4;
  const Vector3 at(quarter, quarter, dimension == 2 ? 0 : quarter);
  Specimen s = specimen_of(cell_of(dimension, side, side, dimension == 2 ? 0.5 : side), {-at, at}, {1.0, 0.8});
  s.solver.min_height = 1.0;  // 3D: the larger grain overlaps with its own images
  return s;
}

void follow_random_increments(const Specimen& start, unsigned seed) {
  Random random(seed);
  const int d = start.cell.dimension;
  for (int path = 0; path < 5; ++path) {
    Rve rve(start);
    Matrix3 f = Matrix3::Identity();
    for (int k = 0; k < 4; ++k) {
      const Matrix3 gradient = random_gradient(random, d, 0.005);
      f = ((Matrix3::Identity() + gradient) * f).eval();
      const Matrix3 stress = rve.apply(gradient, 0).stress;
      const Matrix3 expected = affine_stress(start, f - Matrix3::Identity());
      CHECK(largest(stress - expected) <= 1e-9 * largest(expected));
      CHECK(largest(rve.stress() - stress_by_hand(rve.specimen())) <= 1e-10 * largest(expected));
    }
    CHECK(rve.cell().volume() == Approx(start.cell.volume() * f.determinant()).epsilon(1e-13));
    CHECK(rve.unbalanced_ratio() < 1e-12);
  }
}

}  // namespace

TEST_CASE("One grain and its own images carry kn overlap over the face that each contact spans", "[extreme]") {
  for (const double spacing : {1.999999, 1.99, 1.9, 1.8}) {
    const double force = stiffness * (2 - spacing);
    const Matrix3 plane = Rve(lone_grain(2, spacing)).stress(), space = Rve(lone_grain(3, spacing)).stress();
    for (int k = 0; k < 2; ++k) CHECK(plane(k, k) == Approx(-force / (spacing * 0.5)).epsilon(1e-9));
    for (int k = 0; k < 3; ++k) CHECK(space(k, k) == Approx(-force / (spacing * spacing)).epsilon(1e-9));
    CHECK(plane(2, 2) == 0);
    CHECK(plane(0, 1) == 0);
    CHECK(space(1, 2) == 0);
  }
}

TEST_CASE("One grain, and two unlike ones, keep their places in any lattice and have its stress", "[extreme]") {
  for (const int d : {2, 3}) {
    follow_random_increments(lone_grain(d, 1.95), unsigned(d - 1));
    follow_random_increments(centred(d), unsigned(d + 1));
  }
}

TEST_CASE("One grain of a square lattice resists shear by kt/2 per thickness", "[extreme]") {
  // Two contacts per grain, along x and y; each gives half of its slip to the turning of the grain (C66 = kt/2 as
  // the contact force vanishes). The initial stress adds terms of the order of the overlap, 1e-6 here.
  const double kt = 0.7 * stiffness, size = 1e-9;
  const Specimen start = lone_grain(2, 2 - 2e-6, material(stiffness, kt, 1e6));
  double shear[2];
  for (int side = 0; side < 2; ++side) {
    Rve rve(start);
    const double gamma = side == 0 ? -size : size;
    rve.apply(entry(0, 1, 0.5 * gamma) + entry(1, 0, 0.5 * gamma), 0);
    rve.relax(1e-13, 10'000);
    shear[side] = rve.stress()(0, 1);
  }
  CHECK((shear[1] - shear[0]) / (2 * size) == Approx(0.5 * kt / 0.5).epsilon(1e-5));
}

TEST_CASE("Three unlike grains in a row share one force", "[extreme]") {
  // Springs in series: the three contacts of the row take a third of the overlap each, f = kn (2 sum r - length)/3.
  const std::vector<double> radii = {1.0, 0.7, 0.4};
  for (const int d : {2, 3}) {
    const double length = 4.2 - 0.03, width = 2.5, depth = d == 2 ? 0.5 : 2.5;
    const double along[3] = {-0.4 * length, -0.4 * length + 1.685, -0.4 * length + 1.685 + 1.095};
    std::vector<Vector3> positions;
    for (double x : along) positions.emplace_back(x, 0, 0);
    Rve rve(specimen_of(cell_of(d, length, width, depth), positions, radii));
    const Report report = rve.relax(1e-13, 100'000);
    CHECK(report.target_held);
    const double force = stiffness * 0.03 / 3;
    const Matrix3 stress = rve.stress();
    CHECK(stress(0, 0) == Approx(-force / (width * depth)).epsilon(1e-9));
    CHECK(largest(stress - entry(0, 0, stress(0, 0))) <= 1e-12 * std::abs(stress(0, 0)));

    // Shortening by 1 % adds a third of it to each overlap; the force answers, the other stresses stay zero.
    rve.apply(entry(0, 0, -0.01), 0);
    rve.relax(1e-13, 100'000);
    CHECK(rve.stress()(0, 0) == Approx(-(force + stiffness * 0.01 * length / 3) / (width * depth)).epsilon(1e-9));
  }
}

TEST_CASE("One grain has no fluctuation: it follows the cell at any rate", "[extreme]") {
  for (const int d : {2, 3}) {
    const Specimen start = lone_grain(d, 1.95);
    Rve slow(start), fast(start);
    const Matrix3 gradient = entry(0, d - 1, 0.02) + entry(0, 0, -0.005);
    const Matrix3 expected = affine_stress(start, gradient);
    CHECK(largest(slow.apply(gradient, 0).stress - expected) <= 1e-9 * largest(expected));
    const Response response = fast.apply(gradient, 1e-3);
    CHECK(largest(response.stress - expected) <= 1e-9 * largest(expected));
    CHECK(largest(response.reynolds_stress) == 0);
    CHECK(fast.network().grains[0].velocity.norm() == 0);
  }
}
