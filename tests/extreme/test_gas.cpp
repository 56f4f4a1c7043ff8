// Cells without a single contact, and cells that lose them: no force, no stress at dt = 0; kinetic stress at dt > 0.
// Gases of grains of several sizes that collide: their energy.
#include "tests/catch.hpp"
#include "tests/extreme/energy.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Far apart: gaps of one radius. No grain meets another in these tests.
Specimen sparse(int dimension) {
  if (dimension == 2) return triangular(4, 2, 3.0);
  std::vector<Vector3> positions;
  for (int k = 0; k < 27; ++k) positions.emplace_back(3.0 * (k % 3 - 1), 3.0 * (k / 3 % 3 - 1), 3.0 * (k / 9 - 1));
  return specimen_of(cell_of(3, 9, 9, 9), positions, std::vector<double>(27, 1.0));
}

/// Random velocities (m/s) whose mean is zero.
std::vector<Vector3> thermal(const Rve& rve, unsigned seed, double size) {
  Random random(seed);
  std::vector<Vector3> velocity(rve.size(), Vector3::Zero());
  Vector3 mean = Vector3::Zero();
  for (Vector3& v : velocity) {
    for (int k = 0; k < rve.cell().dimension; ++k) v[k] = random(-size, size);
    mean += v / double(rve.size());
  }
  for (Vector3& v : velocity) v -= mean;
  return velocity;
}

std::vector<Vector3> no_spin(const Rve& rve) { return std::vector<Vector3>(rve.size(), Vector3::Zero()); }

/// -(1/V) sum m v v of equal grains of density 2650 kg/m^3 and radius 1 m.
Matrix3 kinetic_stress(const std::vector<Vector3>& velocity, const Cell& cell) {
  const double mass = 2650 * (cell.dimension == 2 ? pi * 0.5 : 4 * pi / 3);
  Matrix3 sum = Matrix3::Zero();
  for (const Vector3& v : velocity) sum -= mass * v * v.transpose();
  return sum / cell.volume();
}

}  // namespace

TEST_CASE("A gas at dt = 0 has exactly no stress however it is deformed", "[extreme]") {
  for (const int d : {2, 3}) {
    Rve rve(sparse(d));
    const double volume = rve.cell().volume();
    double expansion = 1;
    for (const Matrix3& gradient : {entry(0, d - 1, 0.05), entry(1, 0, -0.03), isotropic(d, -0.02)}) {
      const Response response = rve.apply(gradient, 0);
      expansion *= (Matrix3::Identity() + gradient).determinant();
      CHECK(response.stress.isZero(0));
      CHECK(response.contact_stress.isZero(0));
      CHECK(response.reynolds_stress.isZero(0));
      CHECK(response.report.unbalanced_ratio == 0);
    }
    CHECK(rve.cell().volume() == Approx(volume * expansion).epsilon(1e-14));
    CHECK(rve.network().contacts.empty());
  }
}

TEST_CASE("A gas at dt > 0 has the stress of its velocities, n m <v v>", "[extreme]") {
  for (const int d : {2, 3}) {
    Rve rve(sparse(d));
    const auto velocity = thermal(rve, 7, 10.0);
    rve.set_velocities(velocity, no_spin(rve));
    const Matrix3 expected = kinetic_stress(velocity, rve.cell());
    CHECK(largest(rve.reynolds_stress() - expected) <= 1e-13 * largest(expected));
    const Response response = rve.apply(Matrix3::Zero(), 1e-4);  // 1 mm of 1 m to the next grain
    CHECK(largest(response.reynolds_stress - expected) <= 1e-12 * largest(expected));
    CHECK(response.contact_stress.isZero(0));
    double squares = 0;
    for (const Vector3& v : velocity) squares += v.squaredNorm() / double(velocity.size());
    const double density = 2650 * (d == 2 ? pi * 0.5 : 4 * pi / 3) * double(velocity.size()) / rve.cell().volume();
    CHECK(mean_pressure(response.stress, d) == Approx(density * squares / d).epsilon(1e-12));
    CHECK(net_momentum(rve).norm() <= 1e-13 * momentum_scale(rve));
  }
}

TEST_CASE("A drift of all grains together is no fluctuation", "[extreme]") {
  Rve still(sparse(2)), drifting(sparse(2));
  auto velocity = thermal(still, 7, 10.0);
  still.set_velocities(velocity, no_spin(still));
  for (Vector3& v : velocity) v += Vector3(300, -200, 0);
  drifting.set_velocities(velocity, no_spin(drifting));
  const Matrix3 a = still.apply(Matrix3::Zero(), 1e-4).stress, b = drifting.apply(Matrix3::Zero(), 1e-4).stress;
  CHECK(largest(a - b) <= 1e-10 * largest(a));
}

TEST_CASE("Grains in free flight through a sheared cell keep their laboratory velocities", "[extreme]") {
  // v = v' + g y e_x is constant along the flight of a grain; with dy/dt = v_y: v'_x(t) = v'_x(0) - g t v_y.
  for (const int d : {2, 3}) {
    Rve rve(sparse(d));
    const auto before = thermal(rve, 11, 1.0);
    rve.set_velocities(before, no_spin(rve));
    const double strain = 0.05, dt = 1e-2;
    const Response response = rve.apply(entry(0, d - 1, strain), dt);
    std::vector<Vector3> after = before;
    for (Vector3& v : after) v[0] -= strain * v[d - 1];
    const Network network = rve.network();
    for (std::size_t g = 0; g < rve.size(); ++g) CHECK((network.grains[g].velocity - after[g]).norm() < 1e-12);
    const Matrix3 expected = kinetic_stress(after, rve.cell());
    CHECK(largest(response.reynolds_stress - expected) <= 1e-12 * largest(expected));
    const Matrix3 back = rve.apply(entry(0, d - 1, -strain), dt).stress;
    const Matrix3 at_start = kinetic_stress(before, rve.cell());
    CHECK(largest(back - at_start) <= 1e-12 * largest(at_start));
  }
}

TEST_CASE("A gas in an expanding cell cools as free flight does", "[extreme]") {
  // Expansion to length L = L0 + r t: dv'/dt = -(r/L) v', so v' = v'0 L0/L in each direction.
  Specimen s = sparse(3);
  s.solver.fixed_time_step = 1e-5;
  Rve rve(s);
  const auto before = thermal(rve, 13, 1.0);
  rve.set_velocities(before, no_spin(rve));
  const Matrix3 stress = rve.apply(entry(1, 1, 0.25), 1e-2).stress;
  std::vector<Vector3> after = before;
  for (Vector3& v : after) v[1] /= 1.25;
  const Matrix3 expected = kinetic_stress(after, rve.cell());
  CHECK(largest(stress - expected) <= 1e-6 * largest(expected));
}

TEST_CASE("A gas in a turning cell: fluctuations turn against it at constant energy", "[extreme]") {
  // grad v = W alone: in the laboratory dv'/dt = -W v', so the velocities, and their stress, turn by minus the angle.
  for (const int d : {2, 3}) {
    Specimen s = sparse(d);
    s.solver.fixed_time_step = 1e-5;
    Rve rve(s);
    const auto before = thermal(rve, 17, 1.0);
    rve.set_velocities(before, no_spin(rve));
    const Matrix3 start = rve.stress();
    const Vector3 axis = d == 2 ? Vector3(0, 0, 1) : Vector3(1, 2, -1);
    const Matrix3 turn = rotation_about(axis, 0.4);
    const Matrix3 stress = rve.apply(turn - Matrix3::Identity(), 1e-2).stress;
    CHECK(largest(stress - turn.transpose() * start * turn) <= 1e-6 * largest(start));
    CHECK(stress.trace() == Approx(start.trace()).epsilon(1e-12));
  }
}

TEST_CASE("A gas compressed to half its size in one increment stays without stress if no grains meet", "[extreme]") {
  for (const int d : {2, 3}) {
    Specimen s = lone_grain(d, 5.0);
    Rve rve(s);
    CHECK(rve.apply(isotropic(d, -0.5), 0).stress.isZero(0));
    CHECK(rve.cell().volume() == Approx(s.cell.volume() * std::pow(0.5, d)).epsilon(1e-12));
  }
}

TEST_CASE("Tension of a crystal without cohesion: stress goes to zero, stays, and comes back", "[extreme]") {
  const Material rough = material(stiffness, 0.5 * stiffness, 0.5);
  for (const double dt : {0.0, 0.02}) {
    Rve rve(triangular(4, 2, 1.98, rough));
    const Matrix3 start = rve.stress();
    for (int k = 0; k < 10; ++k) rve.apply(isotropic(2, 0.01), dt);  // contact is lost at 1.01 %
    CHECK(rve.contact_stress().isZero(0));
    CHECK(rve.network().contacts.empty());
    CHECK(rve.apply(isotropic(2, 0.5), dt).contact_stress.isZero(0));
    CHECK(largest(rve.stress()) <= 1e-20 * largest(start));  // dt > 0: round-off in the velocities
    const double back = 1 / (1.5 * std::pow(1.01, 10)) - 1;
    const Matrix3 stress = rve.apply(isotropic(2, back), dt).stress;
    CHECK(largest(stress - start) <= 1e-9 * largest(start));
    CHECK(rve.size() == 16);
  }
}

TEST_CASE("a shock from a gas of grains of several sizes closes the energy balance") {
  const double rate = GENERATE(1e2, 1e4);
  Specimen s = gas(2, spread_radii(60, 0.2), 0.45, 3, material(1e7, 5e6, 0.3));
  s.solver.energy_balance = true;
  s.solver.max_overlap_ratio = 0.9;
  Rve rve(s);
  rve.apply(Matrix3::Zero(), 1e-12);
  EnergyBalance energy(rve);
  rve.apply(isotropic(2, -0.25), 0.25 / rate);
  energy.look();
  CAPTURE(rate);
  CHECK(rve.specimen().state.energy_balance.boundary_work > 0);
  CHECK(energy.residual() < 0.01);
}
