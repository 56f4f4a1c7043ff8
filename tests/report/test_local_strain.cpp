// A uniform strain is the strain around every grain; what moves beside it is a fluctuation.
#include "rvelab/report/local_strain.hpp"

#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "tests/catch.hpp"

using namespace rvelab;

namespace {

constexpr int side = 4;

/// Discs of radius 1 on a square lattice, each touching its four neighbours, one more that touches none.
Network square_lattice() {
  Network network;
  network.shape = round_shape(2);
  network.cell.dimension = 2;
  network.cell.lattice = Eigen::Vector3d(2 * side, 2 * side, 1).asDiagonal();
  for (int k = 0; k < side * side + 1; ++k) {
    GrainState grain;
    grain.radius = 1;
    grain.position = k == side * side ? Vector3(1, 1, 0) : Vector3(2 * (k % side) - side, 2 * (k / side) - side, 0);
    network.grains.push_back(grain);
  }
  for (int k = 0; k < side * side; ++k)
    for (const auto& [x, y] : {std::pair{1, 0}, {0, 1}}) {
      ContactState contact;
      contact.i = k;
      contact.j = (k % side + x) % side + side * ((k / side + y) % side);
      contact.branch = Vector3(2 * x, 2 * y, 0);
      network.contacts.push_back(contact);
    }
  return network;
}

Matrix3 shear_and_compression() {
  Matrix3 F = Matrix3::Identity();
  F(0, 1) = 0.02, F(1, 1) = 0.97;
  return F;
}

}  // namespace

TEST_CASE("a uniform strain is that of every grain, and no fluctuation") {
  const Network before = square_lattice();
  Network after = before;
  const Matrix3 F = shear_and_compression();
  after.cell.lattice = F * before.cell.lattice;
  for (GrainState& grain : after.grains) grain.position = F * grain.position;
  report::Motion motion(before);
  motion.go_on(before, after, F);
  const double expected = deviatoric_strain(0.5 * (F + F.transpose()) - Matrix3::Identity(), 2);
  for (std::size_t g = 0; g < before.grains.size(); ++g) {
    INFO(g);
    CHECK(motion.fluctuation[g].norm() < 1e-14);
    if (g + 1 == before.grains.size()) {
      CHECK(std::isnan(motion.shear[g]));  // no neighbour, no strain
      continue;
    }
    CHECK(motion.shear[g] == Approx(expected));
    CHECK(motion.volume[g] == Approx(0.03));
  }
}

TEST_CASE("a row of grains that slides is strained at its sides, whatever lattice vector it crosses") {
  const Network before = square_lattice();
  Network after = before;
  const double slip = 0.1;
  for (int k = 0; k < side; ++k) after.grains[std::size_t(k)].position[0] += slip + 2 * side;  // one cell further
  report::Motion motion(before);
  motion.go_on(before, after, Matrix3::Identity());
  const double mean = slip * side / double(before.grains.size());
  CHECK(motion.fluctuation[0][0] == Approx(slip - mean));
  CHECK(motion.fluctuation[std::size_t(2 * side)][0] == Approx(-mean));
  // Around the rows beside the sliding one the strain does not vanish; the mean over all rows does.
  CHECK(motion.shear[std::size_t(side)] > 0.003);
  CHECK(motion.volume[std::size_t(side)] == Approx(0).margin(1e-12));
  motion.go_on(after, before, Matrix3::Identity());
  CHECK(motion.fluctuation[0].norm() < 1e-14);
}
