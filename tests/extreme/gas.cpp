// Gases of grains: energy over many collisions, and cooling against Haff's law (J. Fluid Mech. 134, 1983) with the
// collision rate of Enskog and Carnahan and Starling (3D) or Henderson (2D), and the a2 of van Noije and Ernst (1998).
#include <algorithm>
#include <cmath>
#include <optional>

#include "rvelab/measure/measures.hpp"
#include "tests/extreme/energy.hpp"
#include "tests/extreme/matrix.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

namespace {

/// Gas of equal discs or spheres of diameter 2 and granular temperature 1 (m^2/s^2 per freedom), and its theory.
struct HardGas {
  int dimension;
  std::size_t grains;
  double solid_fraction;
  double diameter = 2;

  double number_density() const {
    return solid_fraction / grain_volume(dimension == 2 ? Shape::disc : Shape::sphere, 0.5 * diameter, 1);
  }
  /// Pair correlation of touching grains.
  double at_contact() const {
    const double phi = solid_fraction;
    return dimension == 3 ? (1 - phi / 2) / std::pow(1 - phi, 3) : (1 - 7 * phi / 16) / std::pow(1 - phi, 2);
  }
  /// Collisions of one grain per second at temperature T.
  double collision_rate(double temperature) const {
    const double n = number_density(), root = std::sqrt(pi * temperature);
    return dimension == 3 ? 4 * n * diameter * diameter * at_contact() * root : 2 * n * diameter * at_contact() * root;
  }
  /// Time of Haff's law, T = T0/(1 + t/tau)^2, for restitution e.
  double cooling_time(double e, double temperature) const {
    const double a2 = dimension == 3 ? 16 * (1 - e) * (1 - 2 * e * e) / (81 - 17 * e + 30 * e * e * (1 - e))
                                     : 16 * (1 - e) * (1 - 2 * e * e) / (57 - 25 * e + 30 * e * e * (1 - e));
    return 2 * dimension / ((1 - e * e) * collision_rate(temperature)) / (1 + 3 * a2 / 16);
  }
};

/// The hard gas that soft grains are like, whose contacts last `contact_time` (s). A pair that meets at speed v comes
/// apart at e v from the same distance d, that time later. Hard grains of diameter d' would be there then if
/// d - d' = v contact_time e/(1 + e); v at its mean over collisions, sqrt(pi T). First order in (d - d')/d.
HardGas without_softness(const HardGas& soft, double contact_time, double e, double temperature) {
  HardGas hard = soft;
  hard.diameter -= std::sqrt(pi * temperature) * contact_time * e / (1 + e);
  hard.solid_fraction *= std::pow(hard.diameter / soft.diameter, soft.dimension);
  return hard;
}

/// T(0)/T(t) of Haff's law, dT/dt = -2 T/tau(T), by the midpoint rule.
double cooled_by(const HardGas& soft, double contact_time, double e, double start, double time) {
  const int steps = 200;
  const double dt = time / steps;
  const auto rate = [&](double t) { return -2 * t / without_softness(soft, contact_time, e, t).cooling_time(e, t); };
  double temperature = start;
  for (int k = 0; k < steps; ++k) temperature += dt * rate(temperature + 0.5 * dt * rate(temperature));
  return start / temperature;
}

/// Frictionless, at random places, with Gaussian velocities of mean zero and temperature 1; contacts last `duration`
/// times the mean time between collisions of a grain. `spread`: of the radii about 1, which the theory has.
Specimen gas_specimen(const HardGas& hard, bool hertz, double duration, unsigned seed, double spread = 0) {
  const int d = hard.dimension;
  Specimen s = gas(d, spread_radii(int(hard.grains), spread), hard.solid_fraction, seed);
  const double half_mass = 0.5 * s.materials[0].density * grain_volume(s.shape, 1, s.cell.lattice(2, 2));
  const double speed = 2, contact_time = duration / hard.collision_rate(1);  // a typical speed of approach, 2 sqrt(T)
  const double overlap = hertz ? contact_time * speed / 2.943275 : contact_time * speed / pi;
  s.contact.law = hertz ? Law::hertz_stiffness : Law::linear_stiffness;
  s.materials[0].normal_stiffness = constant_for(hertz, overlap, half_mass, speed);
  s.solver.energy_balance = true;
  return s;
}

std::vector<Vector3> thermal_velocities(const HardGas& hard, unsigned seed) {
  Random random(100 + seed);
  std::vector<Vector3> velocity(hard.grains, Vector3::Zero());
  Vector3 mean = Vector3::Zero();
  for (Vector3& v : velocity) {
    for (int k = 0; k < hard.dimension; ++k)  // Box and Muller
      v[k] = std::sqrt(-2 * std::log(random(0, 1))) * std::cos(2 * pi * random(0, 1));
    mean += v / double(hard.grains);
  }
  double sum = 0;
  for (Vector3& v : velocity) sum += (v -= mean).squaredNorm();
  for (Vector3& v : velocity) v *= std::sqrt(hard.dimension * double(hard.grains) / sum);
  return velocity;
}

double temperature_of(const Rve& rve) {
  const Network network = rve.network();
  double energy = 0, mass = 0;
  for (const GrainState& grain : network.grains) {
    energy += grain.mass * grain.velocity.squaredNorm();
    mass += grain.mass;
  }
  return energy / mass / network.dimension();
}

void gas_keeps_energy(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  const HardGas hard{d, std::size_t(asked("grains")), d == 2 ? 0.4 : 0.25};
  Specimen s = gas_specimen(hard, asked("hertz") != 0, 0.02, 7, asked("spread"));
  s.solver.time_step_factor = asked("time_step_factor");
  Tested tested(s, verdict);
  tested.rve().set_velocities(thermal_velocities(hard, 7), std::vector<Vector3>(hard.grains, Vector3::Zero()));
  if (asked("spread") > 0) tested.apply(Matrix3::Zero(), 1e-9);  // takes out the momentum of unlike masses
  const double start = energy_in(tested.rve());
  const double time = asked("collisions") / hard.collision_rate(1);
  for (int k = 0; k < 20; ++k) {
    tested.apply(Matrix3::Zero(), time / 20);
    verdict.law("energy against that of the start, less one", std::abs(energy_in(tested.rve()) / start - 1),
                asked.tolerance);
  }
  tested.check_laws();
  tested.check_momentum();
}

/// Rate of cooling of one gas over Haff's. Kept small: in cells wider than some dozen free paths, vortices grow that
/// cool no more (Goldhirsch and Zanetti 1993).
/// `ledger`: the energy balance is computed, which takes three times as long.
double cooling_rate(const HardGas& hard, const Case& asked, unsigned seed, bool ledger, Verdict& verdict) {
  Specimen s = gas_specimen(hard, asked("hertz") != 0, asked("contact_time"), seed);
  s.solver.time_step_factor = asked("time_step_factor");
  s.solver.energy_balance = false;
  Rve mixing(s);
  mixing.set_velocities(thermal_velocities(hard, seed), std::vector<Vector3>(hard.grains, Vector3::Zero()));
  mixing.apply(Matrix3::Zero(), 2 / hard.collision_rate(1));
  s = mixing.specimen();
  s.solver.energy_balance = ledger;
  const double e = asked("restitution");
  set_restitution(s, e);
  Tested tested(s, verdict);
  const double first = temperature_of(tested.rve()), tau = hard.cooling_time(e, first);
  const double contact_time = asked("contact_time") / hard.collision_rate(1);
  std::optional<EnergyBalance> energy;
  if (ledger) energy.emplace(tested.rve());
  double moment = 0, squares = 0;
  const int looks = 14;
  for (int k = 1; k <= looks; ++k) {
    tested.apply(Matrix3::Zero(), asked("duration") * tau / looks);
    if (energy) energy->look();
    // Haff: sqrt(T0/T) - 1 = t/tau; the slope through the origin, of what is over what should be.
    const double law = std::sqrt(cooled_by(hard, contact_time, e, first, asked("duration") * tau * k / looks)) - 1;
    moment += law * (std::sqrt(first / temperature_of(tested.rve())) - 1);
    squares += law * law;
  }
  tested.check_laws();
  if (energy) verdict.law("energy closes, of what was lost", energy->residual(), 1e-2);
  return moment / squares;
}

void gas_cools(const Case& asked, Verdict& verdict) {
  // Several small gases: one, with some 1,900 collisions, scatters by 3 %.
  const HardGas hard{int(asked("dimension")), 256, 0.1};
  const unsigned gases = unsigned(asked("gases"));
  double mean = 0;
  for (unsigned k = 0; k < gases; ++k) mean += cooling_rate(hard, asked, 7 + k, k < 2, verdict) / gases;
  verdict.law("rate of cooling over Haff's, less one", std::abs(mean - 1), asked.tolerance);
}

}  // namespace

std::vector<Experiment> gas_experiments() {
  return {{"gas/energy", gas_keeps_energy,
           "dimension 2, hertz 0, grains 100, collisions 100, spread 0, time_step_factor 0.7"},
          {"gas/haff", gas_cools,
           "dimension 2, hertz 0, gases 16, restitution 0.9, duration 3, contact_time 3e-3, time_step_factor 0.7"}};
}

}  // namespace rvelab::test
