// One, two and three grains: cells in which a grain touches its own images. Every grain of these cells but the chain's
// is a centre of symmetry, so that it stays in balance under any homogeneous deformation and the stress is that of the
// affinely moved grains, which a sum over images gives.
#include <numeric>

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

TEST_CASE("One grain, and two unlike ones, keep their places in any lattice and have its stress", "[extreme]") {
  for (const int d : {2, 3}) {
    follow_random_increments(lone_grain(d, 1.95), unsigned(d - 1));
    follow_random_increments(centred(d), unsigned(d + 1));
  }
}

TEST_CASE("Unlike grains in a row share one force", "[extreme]") {
  // Springs in series: the contacts of the row take an equal part of the overlap each, f = kn (2 sum r - length)/n.
  struct Row {
    std::vector<double> radii, along;
    double overlap;
  };
  for (const int d : {2, 3})
    for (const Row& row : {Row{{1, 0.7, 0.4}, {0, 1.685, 2.78}, 0.03}, Row{{1, 0.05}, {0, 1.049}, 0.004}}) {
      CAPTURE(d, row.radii.size());
      const double n = double(row.radii.size()), width = 2.5, depth = d == 2 ? 0.5 : 2.5;
      const double length = 2 * std::accumulate(row.radii.begin(), row.radii.end(), 0.0) - row.overlap;
      std::vector<Vector3> positions;
      for (const double x : row.along) positions.emplace_back(x - 0.4 * length, 0, 0);
      Rve rve(specimen_of(cell_of(d, length, width, depth), positions, row.radii));
      CHECK(rve.relax(1e-13, 100'000).target_held);
      const double force = stiffness * row.overlap / n;
      const Matrix3 stress = rve.stress();
      CHECK(stress(0, 0) == Approx(-force / (width * depth)).epsilon(1e-9));
      CHECK(largest(stress - entry(0, 0, stress(0, 0))) <= 1e-12 * std::abs(stress(0, 0)));
      CHECK(rve.network().contacts.size() == row.radii.size());

      // Shortened, each overlap takes its part; the force answers, the other stresses stay zero.
      const double strain = 0.3 * row.overlap / length;
      rve.apply(entry(0, 0, -strain), 0);
      rve.relax(1e-13, 100'000);
      CHECK(rve.stress()(0, 0) == Approx(-1.3 * force / (width * depth)).epsilon(1e-9));

      // The same balance, whatever takes the energy out.
      for (const double damping : {0.01, 0.9, 0.99}) {
        Specimen damped = specimen_of(cell_of(d, length, width, depth), positions, row.radii);
        damped.damping.local_quasi_static = damped.damping.local = damping;
        Rve still(damped), moving(damped);
        CHECK(still.relax(1e-10, 1'000'000).target_held);
        CHECK(still.stress()(0, 0) == Approx(-force / (width * depth)).epsilon(1e-8));
        moving.apply(Matrix3::Zero(), damping < 0.1 ? 400.0 : 40.0);
        CHECK(moving.contact_stress()(0, 0) == Approx(-force / (width * depth)).epsilon(1e-6));
      }
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
