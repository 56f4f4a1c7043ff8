// Two grains meet, in free flight before and after: speeds, energy and overlap are known from the contact law. The
// approach takes a few contact times, with phases so that the contact begins anywhere within a step.

#include <algorithm>
#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "tests/extreme/matrix.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

namespace {

/// What a collision of two grains without damping comes to (constant_for).
struct Impact {
  double overlap = 0;   ///< largest, m
  double duration = 0;  ///< of the contact, s
};

Impact impact_of(bool hertz, double constant, double reduced_mass, double speed) {
  if (!hertz) return {speed * std::sqrt(reduced_mass / constant), pi * std::sqrt(reduced_mass / constant)};
  const double overlap = std::pow(1.25 * reduced_mass * speed * speed / constant, 0.4);
  return {overlap, 2.943275 * overlap / speed};
}

/// Two grains of radius 1 and one material that come together along x. `stiffness`: N/m, or Young's modulus in Pa.
Specimen pair_of_grains(int dimension, bool hertz, double contact_stiffness) {
  Material grain = material(contact_stiffness);
  grain.young_modulus = contact_stiffness;
  grain.poisson_ratio = 0.2;
  Specimen s =
      specimen_of(cell_of(dimension, 20, 20, dimension == 2 ? 0.5 : 20), {{-2, 0, 0}, {2, 0, 0}}, {1, 1}, grain);
  s.contact.law = hertz ? Law::hertz_mindlin : Law::linear_stiffness;
  return s;
}

double mass_of(const Specimen& s) { return s.materials[0].density * grain_volume(s.shape, 1, s.cell.lattice(2, 2)); }

/// d f_n/d overlap^power of the pair: kn in N/m, or 4/3 E* sqrt(r*) in N/m^1.5.
double law_constant(const Specimen& s) {
  if (s.contact.law == Law::linear_stiffness) return s.materials[0].normal_stiffness;
  const double nu = s.materials[0].poisson_ratio;
  return 4.0 / 3 * s.materials[0].young_modulus / (2 * (1 - nu * nu)) * std::sqrt(0.5);
}

/// Speed of separation over that of approach, one approach phase. NaN while they still touch, or have gone through.
double rebound(Specimen s, double speed, double phase, Verdict& verdict) {
  const bool hertz = s.contact.law != Law::linear_stiffness;
  const Impact impact = impact_of(hertz, law_constant(s), 0.5 * mass_of(s), 2 * speed);
  const double gap = 2 * speed * impact.duration * (8 + phase);
  s.grains.position[0][0] = -1 - 0.5 * gap;
  s.grains.position[1][0] = 1 + 0.5 * gap;
  Tested tested(s, verdict);
  const Vector3 still = Vector3::Zero(), v(speed, 0, 0);
  tested.rve().set_velocities({v, -v}, {still, still});
  tested.apply(Matrix3::Zero(), 40 * impact.duration);
  const Network network = tested.rve().network();
  verdict.law("momentum is zero, of m v", net_momentum(tested.rve()).norm() / (mass_of(s) * speed), 1e-13);
  const bool apart = network.contacts.empty() && network.grains[0].position[0] < network.grains[1].position[0];
  if (!apart) return std::nan("");
  return (network.grains[1].velocity[0] - network.grains[0].velocity[0]) / (2 * speed);
}

/// Stiffness such that grains of 100 m/s overlap by a twentieth of their radius.
Specimen stiff_pair(const Case& asked) {
  const bool hertz = asked("hertz") != 0;
  Specimen s = pair_of_grains(int(asked("dimension")), hertz, hertz ? 6e11 : 1e11);
  s.solver.time_step_factor = asked("time_step_factor");
  return s;
}

void elastic_rebound(const Case& asked, Verdict& verdict) {
  const Specimen s = stiff_pair(asked);
  for (int k = 0; k < 20; ++k)
    verdict.law("rebound without damping, less one", std::abs(rebound(s, asked("speed"), k / 20.0, verdict) - 1),
                asked.tolerance);
}

void restitution(const Case& asked, Verdict& verdict) {
  Specimen s = stiff_pair(asked);
  const double e = asked("restitution");
  s.damping.dashpot = Dashpot::restitution;  // of 1 too
  s.damping.restitution = e;
  s.damping.no_tension = asked("no_tension") != 0;
  for (int k = 0; k < 20; ++k)
    verdict.law("got over asked restitution, less one", std::abs(rebound(s, 0.1, k / 20.0, verdict) / e - 1),
                asked.tolerance);
}

void restitution_beside_contact(const Case& asked, Verdict& verdict) {
  // Another pair touches while the impact begins, at a quarter of its depth: the step that this pair asks for must not
  // be taken for that of the impact.
  const bool hertz = asked("hertz") != 0;
  const double e = asked("restitution"), speed = 0.5;
  for (int k = 0; k < 50; ++k) {
    Specimen s = specimen_of(cell_of(3, 20, 20, 20), {{-2, 0, 0}, {2, 0, 0}, {-2, 6, 0}, {2, 6, 0}}, {1, 1, 1, 1});
    const double half_mass = 0.5 * mass_of(s);
    s.contact.law = hertz ? Law::hertz_stiffness : Law::linear_stiffness;
    s.materials[0].normal_stiffness = constant_for(hertz, 0.02, half_mass, 2 * speed);
    const Impact impact = impact_of(hertz, s.materials[0].normal_stiffness, half_mass, 2 * speed);
    set_restitution(s, e);
    const double gap = 2 * speed * impact.duration * (0.3 + 0.7 * k / 50), near = 1 - 0.125 * impact.overlap;
    const double x[4] = {-1 - 0.5 * gap, 1 + 0.5 * gap, -near, near};
    for (int g = 0; g < 4; ++g) s.grains.position[std::size_t(g)][0] = x[g];
    Tested tested(s, verdict);
    const Vector3 still = Vector3::Zero(), v(speed, 0, 0);
    tested.rve().set_velocities({v, -v, still, still}, {still, still, still, still});
    tested.apply(Matrix3::Zero(), gap / (2 * speed) + 10 * impact.duration);
    const auto& grains = tested.rve().network().grains;
    const double got = (grains[1].velocity[0] - grains[0].velocity[0]) / (2 * speed);
    verdict.law("got over asked restitution, less one", std::abs(got / e - 1), asked.tolerance);
  }
}

void impact_too_hard(const Case& asked, Verdict& verdict) {
  // Energy alone says how deep they go: beyond the limit, whatever the step.
  const bool hertz = asked("hertz") != 0;
  const double speed = 1;
  for (int k = 0; k < 20; ++k) {
    Specimen s = pair_of_grains(int(asked("dimension")), hertz, 1e7);
    const double overlap = asked("overlap_over_limit") * s.solver.max_overlap_ratio;
    s.contact.law = hertz ? Law::hertz_stiffness : Law::linear_stiffness;
    s.materials[0].normal_stiffness = constant_for(hertz, overlap, 0.5 * mass_of(s), 2 * speed);
    const double gap = 0.5 + 0.02 * k;
    s.grains.position = {Vector3(-1 - 0.5 * gap, 0, 0), Vector3(1 + 0.5 * gap, 0, 0)};
    Rve rve(s);
    const Vector3 still = Vector3::Zero(), v(speed, 0, 0);
    rve.set_velocities({v, -v}, {still, still});
    verdict.refusal("an impact beyond the overlap limit",
                    refused(rve, [](Rve& hit) { hit.apply(Matrix3::Zero(), 4.0); }));
  }
}

}  // namespace

std::vector<Experiment> impact_experiments() {
  return {
      {"impact/rebound", elastic_rebound, "dimension 3, hertz 0, speed 0.1, time_step_factor 0.7"},
      {"impact/restitution", restitution, "dimension 3, hertz 0, restitution 0.5, no_tension 0, time_step_factor 0.7"},
      {"impact/third_contact", restitution_beside_contact, "hertz 0, restitution 0.5"},
      {"impact/too_hard", impact_too_hard, "dimension 3, hertz 1, overlap_over_limit 2"}};
}

}  // namespace rvelab::test
