// Stiffness probes by increments, against the elastic tangent and the recorded stiffness.
#include "rvelab/measure/probe.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/measure/tensor_order.hpp"
#include "tests/catch.hpp"
#include "tests/measure/reference_network.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

Rve open_packing(const std::string& name, const std::vector<std::string>& settings) {
  Rve rve(reference_specimen(name, settings));
  forbid_slip(rve);
  return rve;
}

}  // namespace

TEST_CASE("small increments without slip meet the elastic tangent within 1e-6", "[measure]") {
  const nlohmann::json reference = read_json("linear_solve_2d.json").at("C_Pa");
  for (const char* name : {"dense", "medium", "soft", "soft100", "noroll"}) {
    CAPTURE(name);
    const Rve rve = open_packing(name, {"contact.slip=full_radius_ratcheting"});
    const Probe probe = probe_stiffness(rve, 1e-7);
    CHECK(probe.relaxed);
    CHECK(probe.unbalanced_ratio < 1e-10);
    CHECK(relative_distance(probe.stiffness, matrix_of(reference.at(name))) < 1e-6);
    CHECK(relative_distance(elastic_tangent(rve.network()), matrix_of(reference.at(name))) < 1e-8);
  }
}

TEST_CASE("the elastic tangent follows the slip convention that the increments use", "[measure]") {
  const Rve ratcheting = open_packing("soft", {"contact.slip=full_radius_ratcheting"});
  for (const char* slip : {"consistent", "full_radius"}) {
    CAPTURE(slip);
    const Rve rve = open_packing("soft", {std::string("contact.slip=") + slip});
    const Eigen::MatrixXd tangent = elastic_tangent(rve.network());
    CHECK(relative_distance(probe_stiffness(rve, 1e-7).stiffness, tangent) < 1e-6);
    CHECK(relative_distance(tangent, elastic_tangent(ratcheting.network())) > 1e-5);
  }
}

TEST_CASE("Hertz spheres: increments of 1e-7 meet the elastic tangent", "[measure][slow]") {
  for (const bool rescale : {false, true}) {
    CAPTURE(rescale);
    const Rve rve = open_packing("hertz", {std::string("contact.unload_rescale=") + (rescale ? "true" : "false")});
    const Probe probe = probe_stiffness(rve, 1e-7);
    CHECK(probe.relaxed);
    // With rescaling plus and minus differ in their second order, which the mean then keeps: 7e-6 at this size.
    CHECK(relative_distance(probe.stiffness, elastic_tangent(rve.network())) < (rescale ? 1e-5 : 1e-6));
  }
}

TEST_CASE("while no contact slips loading goes on with the elastic stiffness, in whatever direction", "[measure]") {
  const Rve rve = open_packing("dense", {"solver.relative_tolerance=1e-4", "solver.absolute_tolerance=1e-8"});
  const Eigen::MatrixXd elastic = elastic_tangent(rve.network());
  Matrix3 sheared = Matrix3::Zero();
  sheared(0, 1) = 2;  // its symmetric part counts
  for (const Matrix3& direction : {Matrix3(Vector3(0.3, -1, 0).asDiagonal()), sheared, unit_strain(0, 2)}) {
    CAPTURE(direction);
    // A hundredth of the mean overlap: contacts that open or close leave 1 %.
    CHECK(relative_distance(loading_stiffness(rve, direction, 1e-5), elastic) < 0.01);
  }
}

TEST_CASE("the loading stiffness gives along its direction what loading gives, and less than unloading", "[measure]") {
  Rve rve(reference_specimen("dense"));
  const Matrix3 direction = Vector3(0.5, -1, 0).asDiagonal();
  for (int k = 0; k < 10; ++k) rve.apply(1e-3 * direction, 0);  // until contacts slide
  const Matrix3 stress = rve.stress();
  const double size = 1e-3;
  const Matrix3 half = 0.5 * size * direction / direction.norm();
  Rve copy(rve);
  copy.apply(half, 0);
  const Eigen::VectorXd middle = stress_components(copy.stress(), 2);
  copy.apply(half, 0);
  const Eigen::VectorXd change = stress_components(copy.stress(), 2) - middle;

  const Eigen::MatrixXd loading = loading_stiffness(rve, direction, size);
  const Eigen::VectorXd strain = strain_components(half, 2);
  CHECK((loading * strain - change).norm() < 1e-12 * change.norm());
  CHECK(rve.stress() == stress);
  CHECK(loading_stiffness(rve, 7 * direction, size) == loading_stiffness(rve, direction, size));

  const double work = strain.dot(loading * strain);
  CHECK(work < 0.5 * strain.dot(loading_stiffness(rve, Matrix3(-direction), 1e-4) * strain));
  CHECK(work < 0.5 * strain.dot(elastic_tangent(rve.network()) * strain));
  CHECK_THROWS_AS(loading_stiffness(rve, Matrix3::Zero(), size), InputError);
  Matrix3 turn = Matrix3::Zero();
  turn(0, 1) = 1, turn(1, 0) = -1;
  CHECK_THROWS_AS(loading_stiffness(rve, turn, size), InputError);
  CHECK_THROWS_AS(loading_stiffness(rve, direction, 1e-6), InputError);
  CHECK_THROWS_AS(loading_stiffness(rve, direction, 0.02), InputError);
}

TEST_CASE("a probe leaves the specimen as it was and refuses a size that is no small strain", "[measure]") {
  const Rve rve = open_packing("dense", {});
  const Matrix3 stress = rve.stress(), lattice = rve.cell().lattice;
  const std::uint64_t steps = rve.grain_steps();
  probe_stiffness(rve, 1e-7);
  CHECK(rve.stress() == stress);
  CHECK(rve.cell().lattice == lattice);
  CHECK(rve.grain_steps() == steps);
  CHECK_THROWS_AS(probe_stiffness(rve, 0), InputError);
  CHECK_THROWS_AS(probe_stiffness(rve, -1e-7), InputError);
  CHECK_THROWS_AS(probe_stiffness(rve, 0.1), InputError);
}

TEST_CASE("components are in the order of the recorded stiffness", "[measure]") {
  CHECK(component_names(2) == std::vector<std::string>{"xx", "yy", "xy"});
  CHECK(component_names(3) == std::vector<std::string>{"xx", "yy", "zz", "yz", "xz", "xy"});
}
