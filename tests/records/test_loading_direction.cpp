// The direction in which a test goes on, from records made by hand.
#include "rvelab/records/loading_direction.hpp"

#include <vector>

#include "tests/catch.hpp"
#include "tests/ensemble/made_records.hpp"

using namespace rvelab;
using namespace rvelab::records;
using test::biaxial_record;

TEST_CASE("a test goes on in the direction of its last half per cent of strain") {
  std::vector<Record> records;
  CHECK(loading_direction(records).isZero(0));
  for (int k = 0; k <= 10; ++k) records.push_back(biaxial_record(1e-3 * k, -0.2e-3 * k, 1, 1));
  // From there on it widens by 0.8 of what it is shortened by.
  for (int k = 1; k <= 10; ++k) records.push_back(biaxial_record(1e-2 + 1e-3 * k, -2e-3 - 0.8e-3 * k, 1, 1));
  const Matrix3 direction = loading_direction(records);
  CHECK(direction(1, 1) == Approx(-0.005).epsilon(0.03));
  CHECK(-direction(0, 0) / direction(1, 1) == Approx(0.8).epsilon(0.03));  // of strains that are finite
  CHECK(direction(0, 1) == 0);

  // What was before a turn, or in another stage, is no part of it.
  records.push_back(biaxial_record(0.019, -9.9e-3, 1, 1));
  CHECK(loading_direction(records)(1, 1) == Approx(0.001).epsilon(0.03));
  records.push_back(biaxial_record(0, 0, 1, 1));
  records.back().stage = 1;
  CHECK(loading_direction(records).isZero(0));
}

TEST_CASE("the direction of simple shear is that of pure shear, whatever the rotation") {
  const std::vector<Record> records{test::shear_record(0, 0), test::shear_record(0.001, 1),
                                    test::shear_record(0.002, 2)};
  const Matrix3 direction = loading_direction(records);
  CHECK(direction(0, 1) == Approx(0.001).epsilon(1e-12));
  CHECK(direction(1, 0) == direction(0, 1));
  CHECK(direction(0, 0) == Approx(0).margin(1e-15));
}
