// Stiffness, friction, damping and size far from ordinary ones.
#include "tests/catch.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// YADE's dense packing, 400 discs at 100 kPa, with springs and forces times `factor`.
Specimen stiffened(double factor) {
  Specimen s = reference_specimen("dense");
  for (Material& m : s.materials) m.young_modulus *= factor;
  for (Contact& c : s.contacts) {
    c.tangential_force *= factor;
    c.rolling_moment *= factor;
  }
  return s;
}

/// The stress change that brings the specimen to an isotropic pressure.
MixedTarget to_pressure(const Rve& rve, double pressure) {
  const Matrix3 stress = rve.stress();
  MixedTarget target;
  target.rows = {stress_row(0, 0, -pressure - stress(0, 0), pressure),
                 stress_row(1, 1, -pressure - stress(1, 1), pressure),
                 stress_row(0, 1, -0.5 * (stress(0, 1) + stress(1, 0)), pressure)};
  return target;
}

Matrix3 biaxial(double strain) { return Vector3(0.5 * strain, -strain, 0).asDiagonal(); }

void check_torques(const Response& response, double pressure) {
  CHECK(largest(response.stress - response.stress.transpose()) <= response.report.unbalanced_ratio * pressure);
}

}  // namespace

TEST_CASE("Grains 10,000 times stiffer are brought to the same stress, held there and sheared", "[extreme]") {
  const double p0 = 1e5;
  Rve rve(stiffened(1e4));
  const double volume = rve.cell().volume();
  for (const double pressure : {1e8, 1e7, 1e6, p0}) {
    const Response response = rve.apply(to_pressure(rve, pressure), 0);
    CAPTURE(pressure, response.report.held_error, response.report.substeps);
    CHECK(response.report.target_held);
    CHECK(mean_pressure(response.stress, 2) == Approx(pressure).epsilon(0.01));
    Specimen s = rve.specimen();
    s.state = {};  // the pressure reached is from here on the specimen's own
    rve = Rve(s);
  }
  // Less overlap: the cell has grown by about what the overlaps were, 1e-3 of the grains.
  CHECK(rve.cell().volume() > volume);
  CHECK(rve.cell().volume() < 1.01 * volume);
  // Constant lateral stress, axial compression.
  for (int k = 0; k < 8; ++k) {
    const Matrix3 stress = rve.stress();
    MixedTarget target;
    target.rows = {stress_row(0, 0, -p0 - stress(0, 0), p0), strain_row(1, 1, -1e-5), strain_row(0, 1, 0)};
    const Response response = rve.apply(target, 0);
    CAPTURE(k, response.report.held_error, response.report.substeps, response.report.unbalanced_ratio);
    CHECK(response.report.target_held);
    CHECK(response.stress(0, 0) == Approx(-p0).epsilon(0.006));
    CHECK(response.report.substeps < 100'000);
    check_torques(response, p0);
  }
  CHECK(rve.stress()(1, 1) < -p0);
}

TEST_CASE("Without friction every force is along its normal and the stress is symmetric", "[extreme]") {
  Specimen s = reference_specimen("dense");
  s.contact.rolling = false;
  s.materials[0].friction = 0;
  for (Contact& c : s.contacts) c.tangential_force.setZero();
  Rve rve(s);
  for (const double dt : {0.0, 1e-3}) {
    for (int k = 0; k < 5; ++k) {
      const Response response = rve.apply(biaxial(2e-4), dt);
      const Matrix3& stress = response.contact_stress;
      CHECK(largest(stress - stress.transpose()) <= 1e-13 * largest(stress));
    }
    double largest_force = 0, across = 0;
    for (const ContactState& c : rve.network().contacts) {
      largest_force = std::max(largest_force, c.normal_force);
      across = std::max(across, c.tangential_force.norm());
    }
    CHECK(across <= 1e-14 * largest_force);
    CHECK(sliding_fraction(rve.network()) == 1);
    for (const GrainState& g : rve.network().grains) CHECK(g.spin.norm() == 0);
  }
}

TEST_CASE("Friction of 10 is no slip until a contact opens: the stress is that of friction 1e6", "[extreme]") {
  Specimen rough = reference_specimen("dense"), stuck = reference_specimen("dense");
  rough.materials[0].friction = 10;
  stuck.materials[0].friction = 1e6;
  Rve a(rough), b(stuck);
  for (int k = 0; k < 10; ++k) {
    const Matrix3 x = a.apply(biaxial(2e-6), 0).stress, y = b.apply(biaxial(2e-6), 0).stress;
    CHECK(largest(x - y) <= 1e-3 * 1e5 * (k + 1) / 10);
  }
  // Far beyond: the cone holds and the packing stays one.
  const Response response = a.apply(biaxial(0.02), 0);
  CHECK(response.stress.allFinite());
  CHECK(mean_pressure(response.stress, 2) > 0);
  for (const ContactState& c : a.network().contacts)
    CHECK(c.tangential_force.norm() <= 10 * c.normal_force * (1 + 1e-12));
  check_torques(response, mean_pressure(response.stress, 2));
}

TEST_CASE("Springs 10,000 times unlike in one row share one force", "[extreme]") {
  // Contacts of one material: kn, kn/1e4; of two: the harmonic mean. Softest carries the overlap (series).
  const double soft = 1e-4 * stiffness, mixed = 2 * stiffness * soft / (stiffness + soft);
  Specimen s = specimen_of(cell_of(2, 8 - 0.05, 2.5, 0.5), {{-2.97, 0, 0}, {-0.97, 0, 0}, {1.02, 0, 0}, {2.995, 0, 0}},
                           {1, 1, 1, 1});
  s.materials.push_back(material(soft));
  s.grains.material = {0, 0, 1, 1};
  Rve rve(s);
  CHECK(rve.relax(2e-9, 400'000).target_held);
  const double force = 0.05 / (1 / stiffness + 2 / mixed + 1 / soft);
  CHECK(rve.stress()(0, 0) == Approx(-force / (2.5 * 0.5)).epsilon(1e-9));
  rve.apply(entry(0, 0, -0.001), 0);
  CHECK(rve.relax(2e-9, 400'000).target_held);
  const double more = (0.05 + 0.001 * 7.95) / (1 / stiffness + 2 / mixed + 1 / soft);
  CHECK(rve.stress()(0, 0) == Approx(-more / (2.5 * 0.5)).epsilon(1e-9));
}

TEST_CASE("A packing of two stiffnesses 1 : 10,000 gives the stress of its well-resolved run", "[extreme]") {
  const auto run = [](const Specimen& start, long substeps) {
    Specimen s = start;
    s.solver.fixed_substeps = substeps;
    Rve rve(s);
    const double p0 = mean_pressure(rve.stress(), 2);
    for (int k = 0; k < 10; ++k) rve.apply(biaxial(1e-5), 0);
    CHECK(rve.unbalanced_ratio() < 0.1);
    return Matrix3(rve.stress() / p0);
  };
  Specimen loose = gas(2, spread_radii(30, 0.3), 0.4, 15, material(stiffness, 0.5 * stiffness, 0.5));
  loose.materials.push_back(material(1e-4 * stiffness, 0.5e-4 * stiffness, 0.5));
  for (std::size_t g = 0; g < loose.grains.size(); ++g) loose.grains.material[g] = int(g % 2);
  const Specimen s = packed(loose, 1.0);
  const Matrix3 steered = run(s, 0), fine = run(s, 5'000);
  CHECK(largest(steered - fine) <= 1e-2);
}

TEST_CASE("Radii 1 : 20 in one packing: every touching pair is found, forces balance", "[extreme]") {
  for (const int d : {2, 3}) {
    std::vector<double> radii(d == 2 ? 300 : 120, 0.05);
    radii.insert(radii.end(), {1.0, 0.6, 0.3, 0.2, 0.1});
    std::sort(radii.rbegin(), radii.rend());
    Specimen loose = gas(d, radii, d == 2 ? 0.5 : 0.3, 19);
    loose.solver.max_overlap_ratio = 0.5;
    Rve rve(loose);
    for (int k = 0; k < 20; ++k) {
      rve.apply(isotropic(d, d == 2 ? -5e-3 : -1e-2), 0);
      const Matrix3 expected = stress_by_hand(rve.specimen(), stiffness, 1);
      REQUIRE(largest(rve.stress() - expected) <= 1e-10 * std::max(largest(expected), 1.0));
    }
    CHECK(rve.size() == radii.size());
  }
}

TEST_CASE("A restitution of 0.01 leaves a hundredth of the speed of a head-on impact, and no momentum", "[extreme]") {
  // Restitution formula of the linear spring with its dashpot: contact ends where the overlap does.
  for (const int d : {2, 3}) {
    Specimen s = specimen_of(cell_of(d, 8, 4, d == 2 ? 0.5 : 4), {{-1.05, 0, 0}, {1.05, 0, 0}}, {1, 1});
    set_restitution(s, 0.01);
    s.solver.time_step_factor = 0.002;
    s.solver.energy_balance = true;
    Rve rve(s);
    const double speed = 0.1;
    rve.set_velocities({Vector3(speed, 0, 0), Vector3(-speed, 0, 0)}, {Vector3::Zero(), Vector3::Zero()});
    const double start = kinetic_energy(rve.network());
    double rebound = -speed;
    for (int k = 0; k < 400 && rebound < 0; ++k) {
      rve.apply(Matrix3::Zero(), 0.01);
      const Network network = rve.network();
      if (network.contacts.empty()) rebound = network.grains[1].velocity[0];
      CHECK(net_momentum(rve).norm() <= 1e-13 * network.grains[0].mass * speed);
    }
    CHECK(rebound == Approx(0.01 * speed).epsilon(0.02));
    const EnergyTerms ledger = rve.specimen().state.energy_balance;
    const double lost = start - kinetic_energy(rve.network()) - elastic_energy(rve.network());
    CHECK(ledger.dashpot == Approx(lost).epsilon(0.01));
    CHECK(ledger.boundary_work == 0);
  }
}

TEST_CASE("The stress of velocities is the same whoever sums it, drift or not", "[extreme]") {
  // Local damping does not conserve momentum; the mean velocity that the next step takes out is no fluctuation.
  Specimen s = reference_specimen("dense");
  s.damping.local = 0.9;
  Rve rve(s);
  const Response response = rve.apply(biaxial(1e-4), 1e-3);
  const Matrix3 summed = reynolds_stress(rve.network());
  CHECK(largest(summed - response.reynolds_stress) <= 1e-12 * largest(response.reynolds_stress));
}
