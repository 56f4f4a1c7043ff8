// Strong and weak contacts.
#include "rvelab/measure/force_networks.hpp"

#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "tests/catch.hpp"
#include "tests/measure/crystals.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Columns of discs along y that bear `column`, and rows across that bear `row`, a contact each; N.
Network chains(double column, double row) {
  Network network;
  network.shape = Shape::disc;
  network.cell.dimension = 2;
  network.cell.lattice = Vector3(1, 1, 1).asDiagonal();
  network.grains = {grain_at({0, 0, 0}, 0.5)};
  for (const int axis : {0, 1}) {
    ContactState contact = touching(network, 0, 0, {1 - axis, axis, 0});
    contact.normal_force = contact.pressing_force = axis == 1 ? column : row;
    contact.friction = 0.5;
    network.contacts.push_back(contact);
  }
  network.contacts[0].tangential_force = {0, 0.5 * row, 0};  // on the cone
  return network;
}

}  // namespace

TEST_CASE("columns that bear more than the mean are the strong network", "[measure]") {
  const ForceNetworks found = force_networks(chains(3, 1));
  CHECK(found.mean_normal_force == Approx(2));
  CHECK(found.strong.contacts == 0.5);
  CHECK(found.strong.fabric(1, 1) == 1);
  CHECK(found.weak.fabric(0, 0) == 1);
  CHECK(found.strong.pressure_share == Approx(0.75));
  // s has -1 and 1 on its diagonal and, of the row's tangential force, 1/4 beside it: s:s = 17/8; the column's has
  // -3/2 and 3/2, s:s_column = 3.
  CHECK(found.strong.deviator_share == Approx(24.0 / 17));
  CHECK(found.strong.deviator_share + found.weak.deviator_share == Approx(1));
  CHECK(found.strong.sliding == 0);
  CHECK(found.weak.sliding == 1);
  CHECK(found.strong.anisotropy > 1.9);  // all normals along one axis: 2
  CHECK(found.weak.anisotropy < -1.9);
}

TEST_CASE("strong and weak network together are the network", "[measure]") {
  for (const char* name : {"dense", "medium", "soft", "hertz"}) {
    CAPTURE(name);
    const Network network = yade_network(name);
    const ForceNetworks found = force_networks(network);
    const auto& [mean, strong, weak] = found;
    CHECK(strong.contacts + weak.contacts == Approx(1).epsilon(1e-14));
    CHECK(strong.pressure_share + weak.pressure_share == Approx(1).epsilon(1e-12));
    CHECK(strong.deviator_share + weak.deviator_share == Approx(1).epsilon(1e-12));
    CHECK(relative_distance(strong.stress + weak.stress, contact_stress(network)) < 1e-12);
    CHECK(relative_distance(strong.contacts * strong.fabric + weak.contacts * weak.fabric, fabric(network)) < 1e-12);
    // Forces of disordered packings: less than half of the contacts bear more than the mean (Radjai et al. 1996).
    CHECK(strong.contacts < 0.5);
    CHECK(strong.contacts > 0.3);
    CHECK(strong.pressure_share > strong.contacts);
  }
}

TEST_CASE("a network without contacts has no share of them", "[measure]") {
  const ForceNetworks found = force_networks(Network{});
  CHECK(std::isnan(found.strong.contacts));
  CHECK(std::isnan(found.mean_normal_force));
  CHECK(found.weak.stress.isZero());
}
