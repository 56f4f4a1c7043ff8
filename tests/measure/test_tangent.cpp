// Elastic tangent: crystals with exact stiffness, recorded packings, frames, mechanisms.
#include "rvelab/measure/tangent.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/tensor_order.hpp"
#include "tests/catch.hpp"
#include "tests/measure/crystals.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// The affine sum of solver/README.md, all contacts, without initial-stress terms.
Eigen::MatrixXd affine_sum(const Network& network) {
  const int dimension = network.dimension(), size = component_count(dimension);
  const auto same = [](int a, int b) { return a == b ? 1.0 : 0.0; };
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
  for (const ContactState& contact : network.contacts) {
    const Vector3& n = contact.normal;
    for (int row = 0; row < size; ++row) {
      const auto [i, j] = component_axes(row, dimension);
      for (int column = 0; column < size; ++column) {
        const auto [k, l] = component_axes(column, dimension);
        const double nnnn = n[i] * n[j] * n[k] * n[l];
        const double shear = n[i] * n[k] * same(j, l) + n[i] * n[l] * same(j, k) + n[j] * n[k] * same(i, l) +
                             n[j] * n[l] * same(i, k) - 4 * nnnn;
        sum(row, column) += contact.length * contact.length *
                            (contact.normal_stiffness * nnnn + 0.25 * contact.tangential_stiffness * shear);
      }
    }
  }
  return sum / network.cell.volume();
}

}  // namespace

TEST_CASE("a supercell is as stiff as its primitive cell", "[measure]") {
  for (const double spacing : {0.99, 0.95}) {
    const Springs springs{2e6, 7e5, 0.01};
    CHECK(relative_distance(elastic_tangent(face_centred(1, spacing, 3, springs)),
                            elastic_tangent(face_centred(1, spacing, 1, springs))) < 1e-10);
  }
}

TEST_CASE("Bravais crystals strain affinely: condensation takes nothing off", "[measure]") {
  const Springs springs{2e6, 7e5, 0};
  for (const Network& network :
       {triangular(1, 0.97, 2, springs), square(1, 0.9999, 2, springs), face_centred(1, 0.97, 2, springs)}) {
    CHECK(relative_distance(elastic_tangent(network), affine_tangent(network)) < 1e-10);
  }
}

TEST_CASE("the affine tangent is the general sum of nnnn and shear terms where contacts bear no force", "[measure]") {
  for (const char* name : {"medium", "hertz"}) {
    Network network = yade_network(name);
    network.model.slip = Slip::consistent;
    for (ContactState& contact : network.contacts) {
      contact.normal_force = 0;
      contact.tangential_force.setZero();
    }
    CHECK(relative_distance(affine_tangent(network), affine_sum(network)) < 1e-12);
  }
}

TEST_CASE("recorded 2D packings: the independent linear solve within 1e-8 of the largest entry", "[measure]") {
  const nlohmann::json reference = read_json("linear_solve_2d.json").at("C_Pa");
  for (const char* name : {"dense", "medium", "soft", "soft100", "noroll"}) {
    CAPTURE(name);
    CHECK(relative_distance(elastic_tangent(yade_network(name)), matrix_of(reference.at(name))) < 1e-8);
  }
}

TEST_CASE("recorded 3D packing: YADE's probes without friction within 2e-4", "[measure][slow]") {
  const nlohmann::json reference = read_json("hertz_stiffness.json").at("friction_off").at("C_mean_Pa");
  CHECK(relative_distance(elastic_tangent(yade_network("hertz")), matrix_of(reference)) < 2e-4);
}

TEST_CASE("grains that find their own balance soften the packing: affine over condensed is 1.1 to 1.7", "[measure]") {
  for (const char* name : {"dense", "medium", "soft", "soft100", "noroll"}) {
    const Network network = yade_network(name);
    const Eigen::MatrixXd affine = affine_tangent(network), condensed = elastic_tangent(network);
    for (int k = 0; k < affine.rows(); ++k) {
      CAPTURE(name, k);
      CHECK(affine(k, k) > 1.1 * condensed(k, k));
      CHECK(affine(k, k) < 1.7 * condensed(k, k));
    }
    const Matrix3 difference = affine - condensed;
    CHECK(Eigen::SelfAdjointEigenSolver<Matrix3>(difference + difference.transpose()).eigenvalues().minCoeff() > 0);
  }
}

TEST_CASE("a turned specimen has the turned stiffness", "[measure]") {
  const Network network = yade_network("dense");
  const Eigen::MatrixXd straight = elastic_tangent(network);
  const double angle = 0.3;
  const Matrix3 turn = Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix();
  Network turned = network;
  turned.cell.rotation = turn;
  const Eigen::MatrixXd c = elastic_tangent(turned);
  // C'(e) = Q C(Q^T e Q) Q^T
  Eigen::MatrixXd expected(3, 3);
  for (int k = 0; k < 3; ++k) {
    const Matrix3 strain = turn.transpose() * unit_strain(k, 2) * turn;
    const Eigen::Vector3d response = straight * Vector3(strain(0, 0), strain(1, 1), 2 * strain(0, 1));
    Matrix3 stress = Matrix3::Zero();
    stress << response[0], response[2], 0, response[2], response[1], 0, 0, 0, 0;
    expected.col(k) = stress_components(turn * stress * turn.transpose(), 2);
  }
  CHECK(relative_distance(c, expected) < 1e-9);
}

TEST_CASE("rattlers, free spins and separate clusters do not stiffen and do no harm", "[measure]") {
  const Springs springs{2e6, 7e5, 0};
  Network network = triangular(1, 0.99, 2, springs);
  const Eigen::MatrixXd alone = elastic_tangent(network);
  SECTION("a loose grain") {
    network.grains.push_back(grain_at({0, 0, 0}, 0.1));
    CHECK(relative_distance(elastic_tangent(network), alone) < 1e-12);
  }
  SECTION("a grain that leans on one other") {
    network.grains.push_back(grain_at({0, 0, 0}, 0.1));
    ContactState contact = touching(network, 0, 4, {});
    contact.branch = contact.normal = {1, 0, 0};
    contact.length = 1;
    load(contact, springs);
    contact.normal_force = 0;
    network.contacts.push_back(contact);
    CHECK(relative_distance(elastic_tangent(network), alone) < 1e-12);
  }
  SECTION("without tangential stiffness nothing holds the spins") {
    const Network smooth = triangular(1, 0.99, 2, {2e6, 0, 0});
    const Eigen::MatrixXd c = elastic_tangent(smooth);
    CHECK(c(2, 2) == Approx(std::sqrt(3.0) / 4 * (2e6 - 3 * 2e6 * 0.01 / 0.99)).epsilon(1e-8));
  }
  SECTION("two crystals that pass through each other add up") {
    const int count = static_cast<int>(network.grains.size());
    const std::vector<GrainState> grains = network.grains;
    const std::vector<ContactState> contacts = network.contacts;
    for (const GrainState& grain : grains) network.grains.push_back(grain);
    for (ContactState contact : contacts) {
      contact.i += count;
      contact.j += count;
      network.contacts.push_back(contact);
    }
    CHECK(relative_distance(elastic_tangent(network), 2 * alone) < 1e-10);
  }
  SECTION("no contacts, no stiffness") {
    network.contacts.clear();
    CHECK(elastic_tangent(network) == Eigen::MatrixXd::Zero(3, 3));
    CHECK(affine_tangent(network) == Eigen::MatrixXd::Zero(3, 3));
  }
}

TEST_CASE("rescaling on unloading acts where f_t stands and vanishes with it", "[measure]") {
  Network network = face_centred(1, 0.98, 1, {2e6, 1e6, 0});
  network.model.law = Law::hertz_mindlin;
  network.model.unload_rescale = true;
  Network without = network;
  without.model.unload_rescale = false;
  CHECK(relative_distance(elastic_tangent(network), elastic_tangent(without)) < 1e-12);
  // Every contact of a Bravais crystal keeps to the mean motion, so that plus and minus see all or none of a contact's
  // rescaling: the mean has half of it, -(1/V) sum (f_t/2)(-dl/2 delta) (x) b.
  for (ContactState& contact : network.contacts) {
    contact.tangential_force = 1e3 * contact.normal.cross(Vector3(0.3, -0.5, 0.8));
    contact.stiffness_growth = 0.5 / contact.overlap;
  }
  without.contacts = network.contacts;
  Eigen::MatrixXd expected = affine_tangent(without);
  for (int k = 0; k < 6; ++k) {
    Matrix3 change = Matrix3::Zero();
    for (const ContactState& contact : network.contacts) {
      const double elongation = contact.normal.dot(unit_strain(k, 3) * contact.branch);
      change += 0.25 * elongation / contact.overlap * contact.tangential_force * contact.branch.transpose();
    }
    expected.col(k) += stress_components(change / network.cell.volume(), 3);
  }
  CHECK(relative_distance(affine_tangent(network), expected) < 1e-12);
  CHECK(relative_distance(affine_tangent(network), affine_tangent(without)) > 1e-6);
}
