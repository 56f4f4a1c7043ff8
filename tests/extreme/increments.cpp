// Many: a million increments, a hundred thousand rotations, thousands of cycles. Round-off and errors of increments
// must not add up.
#include <Eigen/LU>
#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "tests/extreme/matrix.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

namespace {

void rotated_often(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  Rve rve(usual(d, d == 3));
  rve.apply(1e-3 * shear_direction(d), 0);  // slip in the history
  const Specimen before = rve.specimen();
  const Matrix3 stress = rve.stress();
  Matrix3 turned = Matrix3::Identity();
  Random random(3);
  for (long k = 0; k < long(asked("rotations")); ++k) {
    const Vector3 axis = d == 2 ? Vector3(0, 0, 1) : Vector3(random(-1, 1), random(-1, 1), random(-1, 1));
    const Matrix3 rotation = rotation_about(axis, k % 2 == 0 ? random(-3, 3) : random(-1e-5, 1e-5));
    // What the RVE is given is I + dH, which round-off makes differ from the rotation by an ulp.
    const Matrix3 increment = rotation - Matrix3::Identity();
    rve.apply(increment, 0);
    turned = renormalised((Matrix3::Identity() + increment) * turned);
  }
  const Specimen after = rve.specimen();
  verdict.law("the state is bitwise what it was in the cell frame", same_in_cell_frame(before, after));
  const Matrix3 expected = turned * stress * turned.transpose();
  verdict.law("the stress has turned with the cell", largest(rve.stress() - expected) / largest(stress),
              asked.tolerance);
  const Matrix3& q = after.cell.rotation;
  verdict.law("the frame is orthogonal", largest(q.transpose() * q - Matrix3::Identity()), 1e-14);
}

void many_small_increments(const Case& asked, Verdict& verdict) {
  const long increments = long(asked("increments"));
  const double strain = asked("strain"), total = strain * double(increments);
  const Specimen s = rested(jammed_linear(2, 10, 1e3, 0.5, 0), 1e-12, 400'000);
  Tested tested(s, verdict);
  for (long k = 0; k < increments; ++k) tested.apply(strain * shear_direction(2), 0);
  tested.check_laws();
  const Matrix3 resolved = stress_after(s, total / 100 * shear_direction(2), 100, 1000);
  verdict.agreement("stress against 100 resolved increments, of p",
                    (tested.rve().stress() - resolved).norm() / mean_pressure(resolved, 2), asked.tolerance);
  const Matrix3 lattice = tested.rve().cell().rotation * tested.rve().cell().lattice;
  const Matrix3 expected = (Matrix3::Identity() + total * shear_direction(2)) * s.cell.rotation * s.cell.lattice;
  verdict.law("the lattice is where F takes it", largest(lattice - expected) / largest(expected),
              1e-15 * double(increments));
}

void there_and_back(const Case& asked, Verdict& verdict) {
  // Frictionless springs far below the strain that changes a contact: the way back ends where it began.
  const Specimen s = rested(jammed_linear(2, 16, 1e3, 0.5, 0), 1e-12, 400'000);
  Tested tested(s, verdict);
  const Matrix3 first = tested.rve().stress();
  const double p = tested.pressure();
  const int parts = int(asked("parts"));
  const Matrix3 forth = asked("strain") / parts * (shear_direction(2) + biaxial_direction(2));
  const Matrix3 back = (Matrix3::Identity() + forth).inverse() - Matrix3::Identity();
  for (long k = 0; k < long(asked("cycles")); ++k) {
    for (int part = 0; part < parts; ++part) tested.apply(forth, 0);
    for (int part = 0; part < parts; ++part) tested.apply(back, 0);
  }
  tested.check_laws();
  verdict.agreement("stress against that of the start, of p", (tested.rve().stress() - first).norm() / p,
                    asked.tolerance);
}

}  // namespace

std::vector<Experiment> increment_experiments() {
  return {{"increments/rotations", rotated_often, "dimension 3, rotations 1e5"},
          {"increments/small", many_small_increments, "increments 1e6, strain 1e-9"},
          {"increments/there_and_back", there_and_back, "strain 1e-6, cycles 5000, parts 1"}};
}

}  // namespace rvelab::test
