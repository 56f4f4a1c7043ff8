// Increments of a half, of 1e-300, and alternating ones by the thousand.
#include "tests/catch.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Stress of one frictionless grain in the lattice F L0.
Matrix3 lattice_stress(const Specimen& start, const Matrix3& f) {
  Specimen s = start;
  s.cell.lattice = (f * s.cell.lattice).eval();
  return stress_by_hand(s, stiffness, 9) * (s.cell.volume() / s.cell.lattice.determinant());
}

/// A disordered, jammed, frictional specimen with slip in its history.
Rve sheared(int dimension, int count) {
  const Material rough = material(stiffness, 0.5 * stiffness, 0.5);
  Specimen loose = gas(dimension, spread_radii(count, 0.3), dimension == 2 ? 0.5 : 0.3, 3, rough);
  loose.solver.min_height = 1.0;  // these cells are three grains wide
  Rve rve(packed(loose, dimension == 2 ? 4e3 : 2e3));
  rve.apply(entry(0, dimension - 1, 1e-3), 0);
  return rve;
}

}  // namespace

TEST_CASE("One grain sheared by a half at once has the stress of the sheared lattice", "[extreme]") {
  // A lattice 1.9 wide and 2.6 high touches along x only; sheared by 0.5 of its height its diagonals stay apart.
  for (const int d : {2, 3}) {
    Specimen s = specimen_of(cell_of(d, 1.9, d == 2 ? 2.6 : 2.3, d == 2 ? 0.5 : 2.6), {Vector3::Zero()}, {1.0});
    s.solver.min_height = 0.5;
    const Matrix3 gradient = entry(0, d - 1, 0.5), f = Matrix3::Identity() + gradient;
    Rve once(s), often(s);
    const Matrix3 stress = once.apply(gradient, 0).stress;
    for (int k = 0; k < 50; ++k) often.apply(entry(0, d - 1, 0.01), 0);
    const Matrix3 expected = lattice_stress(s, f);
    REQUIRE(expected(0, 0) < 0);
    CHECK(largest(stress - expected) <= 1e-10 * largest(expected));
    CHECK(largest(often.stress() - expected) <= 1e-10 * largest(expected));
    CHECK(once.cell().volume() == Approx(s.cell.volume()).epsilon(1e-14));
  }
}

TEST_CASE("Shear of a triangular lattice by its period at once comes back to the same stress", "[extreme]") {
  // One disc per cell, a = (l, 0), b = (l/2, sqrt(3)/2 l): a shear of l over the height maps the lattice onto itself.
  const double l = 1.96, height = std::sqrt(3.0) / 2 * l;
  Specimen s = lone_grain(2, l);
  s.cell.lattice(0, 1) = 0.5 * l;
  s.cell.lattice(1, 1) = height;
  s.solver.max_overlap_ratio = 0.5;  // half way the rows stand on top of each other
  Rve rve(s);
  const double pressure = std::sqrt(3.0) * stiffness * (2 / l - 1) / 0.5;
  CHECK(mean_pressure(rve.stress(), 2) == Approx(pressure).epsilon(1e-12));
  const Matrix3 half = rve.apply(entry(0, 1, 0.5 * l / height), 0).stress;
  CHECK(largest(half - lattice_stress(s, Matrix3::Identity() + entry(0, 1, 0.5 * l / height))) <= 1e-9 * pressure);
  const Matrix3 whole = rve.apply(entry(0, 1, 0.5 * l / height), 0).stress;
  CHECK(largest(whole + isotropic(2, pressure)) <= 1e-9 * pressure);
}

TEST_CASE("Increments below the resolution of a number change no grain", "[extreme]") {
  for (const int d : {2, 3}) {
    Rve rve = sheared(d, 16);
    const Specimen before = rve.specimen();
    const Matrix3 stress = rve.stress();
    for (const double size : {1e-300, -1e-300, 4.9e-324, 1e-30, 0.0})
      for (int k = 0; k < 25; ++k)
        for (const Matrix3& gradient : {entry(0, d - 1, size), entry(d - 1, 0, size), isotropic(d, size)})
          rve.apply(gradient, 0);
    CHECK(same_in_cell_frame(rve.specimen(), before));
    CHECK(largest(rve.stress() - stress) <= 1e-14 * largest(stress));
    // At dt > 0 the same increments are a rest of the given time: a relaxed crystal stays as it is.
    Rve crystal(lone_grain(d, 1.95));
    const Matrix3 at_rest = crystal.stress();
    crystal.apply(entry(0, d - 1, 1e-300), 1e-3);
    CHECK(largest(crystal.stress() - at_rest) <= 1e-14 * largest(at_rest));
  }
}

TEST_CASE("Ten thousand increments there and back leave the stress that the lattice has", "[extreme]") {
  for (const double dt : {0.0, 1e-3}) {
    Specimen s = triangular(2, 1, 1.95);
    s.solver.min_height = 1.0;
    Rve rve(s);
    const Matrix3 start = rve.stress();
    Random random(23);
    double expansion = 1;
    for (int k = 0; k < 5000; ++k) {
      Matrix3 gradient = Matrix3::Zero();
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) gradient(i, j) = random(-1e-3, 1e-3);
      const Matrix3 back = (Matrix3::Identity() + gradient).inverse() - Matrix3::Identity();
      rve.apply(gradient, dt);
      rve.apply(back, dt);
      expansion *= (Matrix3::Identity() + gradient).determinant() * (Matrix3::Identity() + back).determinant();
    }
    CHECK(rve.cell().volume() == Approx(s.cell.volume() * expansion).epsilon(1e-10));
    CHECK(rve.cell().volume() == Approx(s.cell.volume()).epsilon(1e-10));
    CHECK(largest(rve.stress() - start) <= 1e-9 * largest(start));
    CHECK(rve.size() == 4);
  }
}

TEST_CASE("Ten thousand shears of alternating sign leave no force in contacts that do not slip", "[extreme]") {
  // Simple shear retraces its own path, so that the tangential springs come back to zero; grains of a triangular
  // lattice do not turn against the mean spin. What is left is the error of the sub-steps, and falls with them.
  const auto drift = [](long substeps) {
    Specimen s = triangular(2, 1, 1.95, material(stiffness, 0.5 * stiffness, 1e6));
    s.solver.min_height = 1.0;
    s.solver.fixed_substeps = substeps;
    Rve rve(s);
    const Matrix3 start = rve.stress();
    for (int k = 0; k < 10'000; ++k) rve.apply(entry(0, 1, k % 2 == 0 ? 1e-4 : -1e-4), 0);
    CHECK(rve.cell().volume() == Approx(s.cell.volume()).epsilon(1e-12));
    return largest(rve.stress() - start) / largest(start);
  };
  const double coarse = drift(20);
  CHECK(coarse <= 1e-4);
  CHECK(drift(80) <= 0.3 * coarse);
}
