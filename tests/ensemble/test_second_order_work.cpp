// Second-order work of tests made by hand.
#include "rvelab/ensemble/second_order_work.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/ensemble/made_records.hpp"

using namespace rvelab;
using namespace rvelab::ensemble;
using namespace rvelab::test;

namespace {

/// A drained biaxial test whose axial stress rises to a peak at the strain `peak`, and falls behind it.
std::vector<records::Record> peaking(double peak) {
  std::vector<records::Record> all;
  for (int k = 0; k <= 200; ++k) {
    const double axial = 0.0005 * k, x = axial / peak;
    all.push_back(biaxial_record(axial, -1.2 * axial, 1e5 + 2e5 * (2 * x - x * x), 1e5));
  }
  return all;
}

}  // namespace

TEST_CASE("second-order work of an elastic increment is d eps : C : d eps") {
  const double lame = 3e7, shear = 2e7, axial = 1e-5, lateral = -4e-6;
  const auto stress = [&](double along, double other) { return 2 * shear * along + lame * (along + other); };
  const std::vector<records::Record> two{
      biaxial_record(0, 0, 0, 0), biaxial_record(axial, lateral, stress(axial, lateral), stress(lateral, axial))};
  const double trace = axial + lateral;
  const double expected = 2 * shear * (axial * axial + lateral * lateral) + lame * trace * trace;
  CHECK(second_order_work(two)[1] == Approx(expected).epsilon(1e-4));
  CHECK(second_order_work(two)[0] == 0);
  // Elastic without Poisson effect: d sigma along d eps.
  const std::vector<records::Record> along{biaxial_record(0, 0, 0, 0),
                                           biaxial_record(axial, lateral, 7 * axial, 7 * lateral)};
  CHECK(normalised_second_order_work(along)[1] == Approx(1).epsilon(1e-8));
}

TEST_CASE("a rotation does no second-order work, and a turned test does the same") {
  const Matrix3 turn = Eigen::AngleAxisd(0.02, Vector3(0, 0, 1)).toRotationMatrix();
  std::vector<records::Record> rotated(2, biaxial_record(0, 0, 3e5, 1e5));
  rotated[1].deformation_gradient = turn;
  rotated[1].stress = turn * rotated[1].stress * turn.transpose();
  CHECK(std::abs(second_order_work(rotated)[1]) < 1e-12 * 3e5);
  const auto before = peaking(0.05);
  auto after = before;
  const Matrix3 far = Eigen::AngleAxisd(0.8, Vector3(0, 0, 1)).toRotationMatrix();
  for (records::Record& record : after) {
    record.deformation_gradient = far * record.deformation_gradient * far.transpose();
    record.stress = far * record.stress * far.transpose();
  }
  for (const std::size_t k : {5u, 60u, 150u})
    CHECK(second_order_work(after)[k] == Approx(second_order_work(before)[k]).epsilon(1e-9));
}

TEST_CASE("a drained test is unstable from its peak on, a hardening one never") {
  const auto test = peaking(0.05);
  const Instability found = instability_of(test);
  CHECK(found.strain == Approx(0.05).margin(0.0006));
  CHECK(found.least < -0.3);
  const Instability hardening = instability_of(peaking(0.2));
  CHECK(std::isnan(hardening.strain));
  CHECK(hardening.least > 0);
  CHECK(std::isnan(instability_of(std::span(test).first(2)).least));
}

TEST_CASE("an undrained test is unstable from the peak of its deviator on, though strength is not reached") {
  std::vector<records::Record> all;
  for (int k = 0; k <= 100; ++k) {
    const double axial = 0.0005 * k, x = axial / 0.02, q = 5e4 * (2 * x - x * x), p = 1e5 * std::exp(-x);
    all.push_back(biaxial_record(axial, -axial / (1 - axial), p + q, p - q));
  }
  CHECK(instability_of(all).strain == Approx(0.02).margin(0.001));
}

TEST_CASE("no increment of work leads from one stage to the next") {
  auto records = peaking(0.05);
  for (std::size_t k = 100; k < records.size(); ++k) records[k].stage = 1;
  CHECK(second_order_work(records)[100] == 0);
  CHECK(second_order_work(records)[101] != 0);
}
