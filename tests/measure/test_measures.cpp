// Stress, fabric, coordination, void ratio, sliding, energies.
#include "rvelab/measure/measures.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "tests/catch.hpp"
#include "tests/measure/crystals.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

double distance(const Matrix3& a, const Matrix3& b) { return (a - b).cwiseAbs().maxCoeff(); }

/// A row of discs along x, the k-th at x = k, radius 0.5001: neighbours touch.
Network row_of_discs(int count) {
  Network network;
  network.shape = Shape::disc;
  network.cell.dimension = 2;
  network.cell.lattice = Vector3(count + 5, 4, 0.1).asDiagonal();
  for (int k = 0; k < count; ++k) network.grains.push_back(grain_at({k + 0.5, 0, 0}, 0.5001));
  for (int k = 0; k + 1 < count; ++k) {
    ContactState contact = touching(network, k, k + 1, {});
    load(contact, {1000, 500, 0});
    network.contacts.push_back(contact);
  }
  return network;
}

}  // namespace

TEST_CASE("pressure of a triangular crystal is sqrt(3) kn (d/l - 1)", "[measure]") {
  for (const double spacing : {0.999, 0.98, 0.9}) {
    const Network network = triangular(1.0, spacing, 2, {1e6, 4e5, 0});
    const Matrix3 stress = contact_stress(network);
    const double expected = std::sqrt(3.0) * 1e6 * (1 / spacing - 1);
    CHECK(mean_pressure(stress, 2) == Approx(expected).epsilon(1e-11));
    CHECK(distance(stress, -expected * Vector3(1, 1, 0).asDiagonal().toDenseMatrix()) < 1e-11 * expected);
    CHECK(coordination_number(network) == 6);
  }
}

TEST_CASE("stress of one contact is minus force times branch over volume", "[measure]") {
  Network network = row_of_discs(2);
  network.contacts[0].normal_force = 3;
  network.contacts[0].tangential_force = {0, 2, 0};
  const Matrix3 stress = contact_stress(network);
  CHECK(stress(0, 0) == Approx(-3 * 1.0 / (7 * 4 * 0.1)));
  CHECK(stress(1, 0) == Approx(-2 * 1.0 / (7 * 4 * 0.1)));
  CHECK(stress(0, 1) == 0);
}

TEST_CASE("recorded packings give the recorded stress, void ratio, coordination and fabric", "[measure]") {
  for (const char* name : {"dense", "medium", "soft", "soft100", "noroll", "hertz"}) {
    CAPTURE(name);
    const Network network = yade_network(name);
    const nlohmann::json meta = read_json(std::string(name) + ".json");
    CHECK(distance(contact_stress(network), recorded_stress(name)) < 1e-6);
    CHECK(void_ratio(network) == Approx(meta.at("void_ratio").get<double>()).epsilon(1e-12));
    CHECK(coordination_number(network) == Approx(meta.at("coordination_number").get<double>()).epsilon(1e-12));
    CHECK(unbalanced_force_ratio(network) == Approx(meta.at("unbalanced_force_ratio").get<double>()).epsilon(0.1));
    const nlohmann::json rows = meta.at("fabric_tensor_contact_normals");
    const Matrix3 phi = fabric(network);
    for (int i = 0; i < network.dimension(); ++i) {
      for (int j = 0; j < network.dimension(); ++j) CHECK(phi(i, j) == Approx(rows[i][j].get<double>()).margin(1e-12));
    }
    CHECK(mechanical_void_ratio(network) > void_ratio(network));
    CHECK(mechanical_coordination_number(network) > coordination_number(network));
  }
}

TEST_CASE("a turned frame turns tensors and leaves scalars", "[measure]") {
  Network network = yade_network("hertz");
  const Matrix3 stress = contact_stress(network), phi = fabric(network), branches = branch_fabric(network);
  const double before = fabric_anisotropy(phi, 3);
  const Matrix3 turn = Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  network.cell.rotation = turn;
  CHECK(distance(contact_stress(network), turn * stress * turn.transpose()) < 1e-14 * stress.norm());
  CHECK(distance(fabric(network), turn * phi * turn.transpose()) < 1e-15);
  CHECK(distance(branch_fabric(network), turn * branches * turn.transpose()) < 1e-15);
  CHECK(fabric_anisotropy(fabric(network), 3) == Approx(before).epsilon(1e-12));
  CHECK(fabric(network).trace() == Approx(1));
  CHECK(branch_fabric(network).trace() == Approx(1));
}

TEST_CASE("pressures, deviators and shear strains of element tests", "[measure]") {
  const Matrix3 biaxial = Vector3(-1e5, -3e5, 0).asDiagonal(), triaxial = Vector3(-1e5, -1e5, -3e5).asDiagonal();
  CHECK(mean_pressure(biaxial, 2) == Approx(2e5));
  CHECK(deviatoric_stress(biaxial, 2) == Approx(1e5));
  CHECK(mean_pressure(triaxial, 3) == Approx(5e5 / 3));
  CHECK(deviatoric_stress(triaxial, 3) == Approx(2e5));
  Matrix3 shear = Matrix3::Zero();
  shear(0, 1) = 0.01;
  CHECK(deviatoric_strain(shear, 2) == Approx(0.01));
  CHECK(deviatoric_strain(Vector3(0.01, -0.01, 0).asDiagonal(), 2) == Approx(0.02));
  CHECK(deviatoric_strain(Vector3(0.005, 0.005, -0.01).asDiagonal(), 3) == Approx(0.01));
  CHECK(deviatoric_strain(0.3 * Matrix3::Identity(), 3) == Approx(0).margin(1e-15));
  shear(1, 0) = -0.01;  // a spin
  CHECK(deviatoric_strain(shear, 2) == 0);
}

TEST_CASE("anisotropy is the amplitude of the distribution of normals", "[measure]") {
  SECTION("2D: E = (1 + a cos 2(theta - theta_a))/2pi by quadrature") {
    const double a = 0.37, angle = 0.4;
    Matrix3 phi = Matrix3::Zero();
    const int steps = 64;
    for (int k = 0; k < steps; ++k) {
      const double theta = 2 * pi * k / steps;
      const Vector3 n(std::cos(theta), std::sin(theta), 0);
      phi += (1 + a * std::cos(2 * (theta - angle))) / steps * n * n.transpose();
    }
    CHECK(fabric_anisotropy(phi, 2) == Approx(a).epsilon(1e-12));
  }
  SECTION("3D: E = (1 + F_kl n_k n_l)/4pi has phi = I/3 + 2 F/15, and Fa = sqrt(3 F:F/2)") {
    const Matrix3 f = 0.4 * Vector3(-1.0 / 3, -1.0 / 3, 2.0 / 3).asDiagonal().toDenseMatrix();
    CHECK(fabric_anisotropy(Matrix3::Identity() / 3 + 2 * f / 15, 3) == Approx(0.4).epsilon(1e-12));
  }
  CHECK(fabric_anisotropy(Vector3(1, 0, 0).asDiagonal(), 2) == Approx(2));
  CHECK(fabric_anisotropy(fabric(triangular(1, 0.99, 1, {})), 2) == Approx(0).margin(1e-14));
  CHECK(fabric_anisotropy(fabric(face_centred(1, 0.99, 1, {})), 3) == Approx(0).margin(1e-14));
}

TEST_CASE("a chain with a loose end falls away grain by grain, a closed ring stays", "[measure]") {
  Network network = row_of_discs(5);
  for (const bool removed : rattlers(network)) CHECK(removed);
  CHECK(coordination_number(network) == Approx(8.0 / 5));
  CHECK(std::isnan(mechanical_coordination_number(network)));
  // The first three as a ring closed by a further contact (its place does not matter to the count).
  network.contacts.push_back(touching(network, 0, 2, {}));
  const std::vector<bool> removed = rattlers(network);
  CHECK(removed == std::vector<bool>{false, false, false, true, true});
  CHECK(mechanical_coordination_number(network) == 2);
  const double disc = pi * 0.5001 * 0.5001 * 0.1, volume = 10 * 4 * 0.1;
  CHECK(void_ratio(network) == Approx(volume / (5 * disc) - 1));
  CHECK(mechanical_void_ratio(network) == Approx(volume / (3 * disc) - 1));
}

TEST_CASE("a grain that touches its own image has two contacts", "[measure]") {
  const Network network = square(1, 0.99, 1, {});
  CHECK(network.contacts.size() == 2);
  CHECK(contact_counts(network) == std::vector<int>{4});
  CHECK(coordination_number(network) == 4);
  CHECK_FALSE(rattlers(network)[0]);
}

TEST_CASE("contacts on the friction cone slide, those inside stick", "[measure]") {
  Network network = row_of_discs(5);
  const double forces[] = {0.5, 0.5 * (1 - 0.9e-6), 0.5 * (1 - 1.1e-6), 0};
  for (int k = 0; k < 4; ++k) {
    network.contacts[k].normal_force = network.contacts[k].pressing_force = 1;
    network.contacts[k].friction = 0.5;
    network.contacts[k].tangential_force = {0, forces[k], 0};
  }
  CHECK(sliding_fraction(network) == 0.5);
  for (ContactState& contact : network.contacts) {
    contact.friction = 0;
    contact.tangential_force.setZero();
  }
  CHECK(sliding_fraction(network) == 1);
}

TEST_CASE("the unbalanced ratio has a floor and divides by no zero", "[measure]") {
  Network network = row_of_discs(3);
  for (ContactState& contact : network.contacts) contact.normal_force = 4;
  network.grains[0].resultant = {3, 0, 0};
  CHECK(unbalanced_force_ratio(network) == Approx(1.0 / 4));
  network.reference_contact_force = 2e4;
  CHECK(unbalanced_force_ratio(network) == Approx(1.0 / 20));
  network.contacts.clear();
  CHECK(unbalanced_force_ratio(network) == Approx(1.0 / 20));
  network.reference_contact_force = 0;
  CHECK(unbalanced_force_ratio(network) == 0);
  CHECK(sliding_fraction(network) == 0);
  CHECK(std::isnan(fabric(network)(0, 0)));
  CHECK(contact_stress(network) == Matrix3::Zero());
}

TEST_CASE("fluctuations carry stress and energy at a rate, none when quasi-static", "[measure]") {
  Network network = row_of_discs(2);
  network.cell.rotation = Eigen::AngleAxisd(pi / 2, Vector3::UnitZ()).toRotationMatrix();
  for (GrainState& grain : network.grains) grain.mass = 2, grain.inertia = 0.5;
  network.grains[0].velocity = {3, 0, 0};
  network.grains[1].spin = {0, 0, 4};
  network.loading = Loading::quasi_static;
  CHECK(reynolds_stress(network) == Matrix3::Zero());
  CHECK(kinetic_energy(network) == 0);
  network.loading = Loading::at_rate;
  const Matrix3 stress = reynolds_stress(network);
  CHECK(stress(1, 1) == Approx(-2 * 9 / network.cell.volume()));
  CHECK(stress(0, 0) == Approx(0).margin(1e-12));
  CHECK(kinetic_energy(network) == Approx(0.5 * 2 * 9 + 0.5 * 0.5 * 16));
}

TEST_CASE("pressure is the change of elastic energy with volume", "[measure]") {
  const double spacing = 0.97, step = 1e-5;
  const auto energy = [&](double l) { return elastic_energy(triangular(1, l, 3, {1e6, 0, 0})); };
  const Network network = triangular(1, spacing, 3, {1e6, 0, 0});
  const double area_change = 2 * step * network.cell.volume() * 2;
  const double pressure = -(energy(spacing * (1 + step)) - energy(spacing * (1 - step))) / area_change;
  CHECK(pressure == Approx(mean_pressure(contact_stress(network), 2)).epsilon(1e-8));
}

TEST_CASE("overlaps, diameters, density and the inertial number", "[measure]") {
  Network network = row_of_discs(2);
  network.grains[1].radius = 0.6;
  network.contacts[0] = touching(network, 0, 1, {});
  CHECK(largest_overlap_ratio(network) == Approx(0.1001 / 0.5001));
  CHECK(mean_diameter(network) == Approx(1.1001));
  for (GrainState& grain : network.grains) grain.mass = 2650 * grain_volume(Shape::disc, grain.radius, 0.1);
  CHECK(solid_density(network) == Approx(2650));
  Matrix3 rate = Matrix3::Zero();
  rate(0, 1) = 0.5;
  CHECK(inertial_number(rate, 2, 0.2, 2650, 1e4) == Approx(0.5 * 0.2 * std::sqrt(0.265)));
  CHECK(inertial_number(Vector3(0, -0.06, 0).asDiagonal(), 2, 0.01, 2650, 1e4) ==
        Approx(0.06 * 0.01 * std::sqrt(0.265)));
  CHECK(inertial_number(rate, 2, 0.2, 2650, 0) == std::numeric_limits<double>::infinity());
  CHECK(inertial_number(Matrix3::Zero(), 2, 0.2, 2650, 0) == 0);
}
