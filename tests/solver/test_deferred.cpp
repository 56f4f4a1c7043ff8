// Increments that are a small part of a sub-step share one: the strain adds up exactly, the stress follows within its
// estimate, and nobody who looks or goes on can tell.
#include <Eigen/LU>

#include <cmath>

#include "rvelab/error.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

const Matrix3 biaxial_path = gradient(0.45, 0, 0, -0.9), sheared_path = gradient(0.3, 0.6, 0, -0.3);

/// The dense packing on a biaxial path of 2e-5, and then in pieces of 1e-7 until one of them is deferred.
Rve on_its_way() {
  Rve rve(reference_specimen("dense"));
  for (int k = 0; k < 20; ++k) rve.apply(1e-6 * biaxial_path, 0);
  for (int k = 0; k < 100; ++k)
    if (rve.apply(1e-7 * biaxial_path, 0).report.substeps == 0) return rve;
  FAIL("none of a hundred increments of 1e-7 was deferred");
  return rve;
}

/// What the rest of a path answers and costs.
struct Rest {
  Matrix3 stress;
  long substeps = 0;
};
Rest rest_of_path(Rve rve, const Matrix3& increment, int times) {
  Rest rest;
  for (int k = 0; k < times; ++k) {
    const Response response = rve.apply(increment, 0);
    rest.substeps += response.report.substeps;
    rest.stress = response.stress;
  }
  return rest;
}

}  // namespace

TEST_CASE("Increments of 1e-7 and 1e-9 share sub-steps, and answer as the whole path", "[solver]") {
  const Specimen s = reference_specimen("dense");
  const Rest whole = rest_of_path(Rve(s), 1e-4 * biaxial_path, 1),
             fine = rest_of_path(Rve(s), 1e-7 * biaxial_path, 1000);
  CHECK(fine.substeps < 300);
  const double change = (whole.stress - Rve(s).stress()).norm();
  CHECK((fine.stress - whole.stress).norm() <= 1e-2 * change + 1e-4 * 1e5);
  const Rest finest = rest_of_path(on_its_way(), 1e-9 * biaxial_path, 1000);
  CHECK(finest.substeps < 20);
}

TEST_CASE("Strain that is deferred is in the cell, to the last bit that a product can hold", "[solver]") {
  Rve rve(reference_specimen("dense"));
  const Cell start = rve.cell();
  Matrix3 total = Matrix3::Identity();
  long deferred = 0;
  for (int k = 0; k < 500; ++k) {
    const Matrix3 increment = (k < 400 ? 1e-7 : -1e-7) * sheared_path;
    deferred += rve.apply(increment, 0).report.substeps == 0;
    total = (Matrix3::Identity() + increment) * total;
    const Matrix3 lattice = rve.cell().rotation * rve.cell().lattice, expected = total * start.rotation * start.lattice;
    REQUIRE((lattice - expected).norm() <= 1e-13 * expected.norm());
  }
  CHECK(deferred > 300);
}

TEST_CASE("Who looks at a cell with deferred strain sees its stress, and changes no bit of it", "[solver]") {
  Rve rve = on_its_way();
  const Response last = rve.apply(1e-8 * biaxial_path, 0);
  REQUIRE(last.report.substeps == 0);
  const std::vector<std::byte> before = rve.save();
  CHECK((rve.stress() - last.stress).norm() <= 1e-12 * last.stress.norm());
  CHECK((rve.contact_stress() - last.stress).norm() <= 1e-12 * last.stress.norm());
  const Network network = rve.network();  // of a copy that makes the sub-step
  CHECK((network.cell.lattice - rve.cell().lattice).norm() <= 1e-14 * rve.cell().lattice.norm());
  CHECK(rve.save() == before);
  CHECK(Rve(rve).save() == before);
  rve.release();
  CHECK(rve.save() == before);
  CHECK((rve.stress() - last.stress).norm() <= 1e-12 * last.stress.norm());
}

TEST_CASE("Of deferred increments 19 in 20 are within their estimate of the line between the sub-steps", "[solver]") {
  Rve rve = on_its_way();
  std::vector<Response> since;  // the last sub-step, what was deferred after it
  int deferred = 0, within = 0;
  for (int k = 0; k < 3000; ++k) {
    const Response response = rve.apply(1e-7 * biaxial_path, 0);
    since.push_back(response);
    if (response.report.substeps == 0) continue;
    if (since.front().report.substeps > 0)
      for (std::size_t n = 1; n + 1 < since.size(); ++n) {
        const double part = double(n) / double(since.size() - 1);
        const Matrix3 line = (1 - part) * since.front().stress + part * response.stress;
        within += (since[n].stress - line).norm() <= since[n].report.error_estimate;
        ++deferred;
      }
    since = {response};
  }
  CHECK(deferred > 2000);
  CHECK(within >= 0.95 * deferred);
}

TEST_CASE("A turn, a reversal, a rotation and a refusal meet deferred strain", "[solver]") {
  const Rve way = on_its_way();
  const Matrix3 stress = way.stress();

  Rve back = way;  // what was deferred is made first, then the turn
  CHECK(back.apply(-1e-7 * biaxial_path, 0).report.substeps > 1);
  CHECK((back.stress() - stress).norm() < 1e-3 * 1e5);

  Rve aside = way;
  CHECK(aside.apply(1e-9 * sheared_path, 0).report.substeps > 0);

  Rve turned = way;
  Matrix3 rotation;
  rotation << std::cos(0.3), -std::sin(0.3), 0, std::sin(0.3), std::cos(0.3), 0, 0, 0, 1;
  const Response response = turned.apply(rotation - Matrix3::Identity(), 0);
  CHECK(response.report.substeps == 0);
  CHECK((response.stress - rotation * stress * rotation.transpose()).norm() <= 1e-12 * stress.norm());
  CHECK((turned.cell().rotation * turned.cell().lattice - rotation * way.cell().rotation * way.cell().lattice).norm() <=
        1e-13 * way.cell().lattice.norm());

  Rve refused = way;
  const std::vector<std::byte> before = refused.save();
  CHECK_THROWS_AS(refused.apply(gradient(std::nan(""), 0, 0, 0), 0), InvalidIncrement);
  CHECK_THROWS_AS(refused.apply(gradient(0, 0, 0, -1), 0), InvalidIncrement);
  CHECK_THROWS_AS(refused.apply(gradient(-0.4, 0, 0, -0.4), 0), IncrementFailed);
  CHECK(refused.save() == before);

  // Parameters and velocities that are refused do not make it either.
  CHECK_THROWS_AS(refused.set_materials({}), InputError);
  CHECK_THROWS_AS(refused.set_velocities({}, {}), InputError);
  CHECK(refused.save() == before);

  Rve at_rate = way;  // physical masses know no deferred strain
  const Matrix3 increment = 1e-7 * biaxial_path;
  at_rate.apply(increment, 10 * at_rate.critical_time_step());
  const Matrix3 expected = (Matrix3::Identity() + increment) * way.cell().rotation * way.cell().lattice;
  CHECK((at_rate.cell().rotation * at_rate.cell().lattice - expected).norm() <= 1e-13 * expected.norm());
}

TEST_CASE("No increment is deferred where none can be judged", "[solver]") {
  Specimen s = reference_specimen("dense");
  s.solver.fixed_substeps = 1;
  CHECK(rest_of_path(Rve(s), 1e-9 * biaxial_path, 50).substeps == 50);
  s.solver.fixed_substeps = 0;
  s.solver.absolute_tolerance = 1e-12;  // stricter than what two slopes in turn can tell
  s.solver.relative_tolerance = 1e-12;
  CHECK(rest_of_path(Rve(s), 1e-7 * biaxial_path, 20).substeps >= 20);
}

TEST_CASE("A trial of deferred strain copies no grain, and is committed and reverted as any other", "[solver]") {
  const Rve start = on_its_way();
  const Matrix3 small = 1e-8 * biaxial_path;
  Rve applied(start), tried(start);
  const Response response = applied.apply(small, 0);
  REQUIRE(response.report.substeps == 0);

  CHECK(tried.attempt(small, 0).stress == response.stress);
  CHECK(tried.pending());
  CHECK(tried.memory().trial < 1000);  // of 400 grains
  CHECK(tried.save() == applied.save());
  CHECK(tried.cell().lattice == applied.cell().lattice);
  tried.exchange();
  CHECK(tried.save() == start.save());
  CHECK(tried.cell().lattice == start.cell().lattice);
  tried.exchange();
  CHECK(tried.save() == applied.save());

  tried.revert();
  CHECK(tried.save() == start.save());
  CHECK(tried.attempt(small, 0).stress == response.stress);
  tried.release();
  tried.commit();
  CHECK(tried.save() == applied.save());
  // On from there, through increments that make sub-steps: trials of both kinds follow each other.
  for (int k = 0; k < 300; ++k) {
    const Matrix3 increment = (k % 3 + 1) * 1e-7 * biaxial_path;
    applied.apply(increment, 0);
    if (k % 5 == 0) {
      tried.attempt(0.5 * increment, 0);
      tried.revert();
    }
    tried.attempt(increment, 0);
    tried.commit();
  }
  CHECK(tried.save() == applied.save());
}
