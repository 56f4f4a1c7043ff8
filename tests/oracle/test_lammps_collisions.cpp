// Two and three spheres against records of LAMMPS (release of 29 September 2021, package GRANULAR), force by force.
#include "tests/catch.hpp"
#include "tests/oracle/reference_collision.hpp"

namespace {

using namespace rvelab::test;

/// The bar: forces within 1e-6 of the largest of the record, torques within that of the largest torque. Velocities, in
/// m/s, follow within a millionth of the impact's; spins within a millionth of 1 rad/s.
void check_record(const std::string& name, double nudge = 0) {
  const CollisionDifference found = compare_with_record(name, nudge);
  CAPTURE(name, found.force / found.largest_force, found.torque, found.largest_torque, found.position, found.velocity,
          found.spin);
  CHECK(found.rows > 30);
  CHECK(found.largest_force > 1);
  CHECK(found.force <= 1e-6 * found.largest_force);
  CHECK(found.torque <= 1e-6 * std::max(found.largest_torque, 1e-9));
  CHECK(found.position <= 1e-9);
  CHECK(found.velocity <= 1e-6);
  CHECK(found.spin <= 1e-6);
}

}  // namespace

TEST_CASE("two spheres collide head on as in LAMMPS, force by force", "[oracle]") {
  // These gaps close after a whole number of steps: the spheres then stand at r_i + r_j within round-off, and touch
  // (with the dashpot's force) or not. The nudge makes it the record's case.
  check_record("head_hooke", -1e-13);
  check_record("head_seed3");
  check_record("head_hertzmat_tsuji", -11 * 0x1p-55);  // delta^(1/4): even the size of that round-off shows, by 6e-6
  check_record("head_hertzmat_visco");
}

TEST_CASE("two linear spheres stick and slide in an oblique collision as in LAMMPS", "[oracle]") {
  check_record("obl_hooke_stick");
  check_record("obl_hooke_slide");
}

TEST_CASE("two spinning Hertz spheres collide obliquely as in LAMMPS", "[oracle]") {
  check_record("obl_seed3");
  check_record("obl_seed3_xt1");
}

TEST_CASE("Hertz-Mindlin spheres rescale their tangential force on unloading as in LAMMPS", "[oracle]") {
  check_record("obl_hm_stick_mindlin_rescale_force");
}

TEST_CASE("pressing, shearing, unloading and spinning along a path gives the forces of LAMMPS", "[oracle]") {
  check_record("path_hooke");
  check_record("path_seed3");
  check_record("path_seed3_mu10");
  check_record("path_hm_mindlin_rescale_force");
}

TEST_CASE("an impact runs through a chain of three spheres as in LAMMPS", "[oracle]") {
  check_record("chain_seed3", 1e-13);  // see head on
  check_record("chain_hooke", -1e-13);
}
