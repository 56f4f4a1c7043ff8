#include "rvelab/pack/agitation.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/pack/first_contact.hpp"

namespace rvelab::pack {

namespace {

/// Overlap of a collision, over the gap that the expansion opens.
constexpr double overlap_of_collision = 0.1;
/// Distance that a grain covers, over that gap. Of 500 spheres that had 6.48 contacts a grain, expanded by 0.8 %, those
/// that bear have 5.5, 5.15, 5.0, 5.0 at the end after 3, 10, 30, 100 gaps. Stiff grains forget their contacts at any
/// expansion: numbers between are those of shorter agitations, in proportion to the expansion up to this strain.
/// Random moves without overlaps leave 5.4 of them and shaking at a rate 5.2 (tools/validate preparation).
constexpr double longest_distance = 30, expansion_of_longest = 5e-3;
/// Sub-steps of a collision: with 20 instead of 8 no number of contacts differs by more than its scatter.
constexpr long steps_of_collision = 8;
/// Parts after each of which the work may be interrupted.
constexpr int parts = 20;

/// A deviate of variance 1 in each component, sums of four uniform ones: the same on every machine.
Vector3 random_direction(int dimension, Uniform& uniform) {
  Vector3 v = Vector3::Zero();
  for (int k = 0; k < dimension; ++k) v[k] = std::sqrt(3.0) * (uniform() + uniform() + uniform() + uniform() - 2);
  return v;
}

/// Means over a network under stress.
struct Scales {
  double gap = 0;             ///< m, that the expansion opens
  double mass = 0;            ///< kg
  double kinetic_energy = 0;  ///< J, of a grain whose collisions overlap as they shall
};

Scales scales_of(const Network& network, double expansion) {
  double energy = 0, work = 0, overlap = 0, diameter = 0;
  Scales scales;
  for (const ContactState& contact : network.contacts) {
    energy += contact.elastic_energy;
    work += contact.normal_force * contact.overlap;
    overlap += contact.overlap;
  }
  if (!(energy > 0)) throw IncrementFailed("packing: there are no contacts to agitate");
  for (const GrainState& grain : network.grains) {
    diameter += 2 * grain.radius;
    scales.mass += grain.mass;
  }
  const double contacts = double(network.contacts.size()), grains = double(network.grains.size());
  scales.gap = expansion * diameter / grains;
  scales.mass /= grains;
  // Energy goes with a power of the overlap: 2 linear, 5/2 Hertz.
  const double power = std::clamp(work / energy, 2.0, 3.0);
  scales.kinetic_energy = energy / contacts * std::pow(overlap_of_collision * scales.gap / (overlap / contacts), power);
  return scales;
}

/// The grains (bodies) with the same kinetic energy on average, and no momentum, at a rate.
Rve moving(const Rve& rve, double energy, Uniform& uniform) {
  const Network network = rve.network();
  std::vector<Vector3> velocities;
  Vector3 momentum = Vector3::Zero();
  double mass = 0;
  for (const GrainState& grain : network.grains) {
    velocities.push_back(std::sqrt(2 * energy / network.dimension() / grain.mass) *
                         random_direction(network.dimension(), uniform));
    momentum += grain.mass * velocities.back();
    mass += grain.mass;
  }
  Specimen s = rve.specimen();
  s.state = SolverState{};
  s.state.last_step.loading = Loading::at_rate;
  for (std::size_t k = 0; k < velocities.size(); ++k) {
    if (s.bodies.empty())
      s.grains.velocity[k] = velocities[k] - momentum / mass;
    else
      s.bodies[k].velocity = velocities[k] - momentum / mass;
  }
  for (Vector3& spin : s.grains.spin) spin.setZero();
  for (Body& body : s.bodies) body.spin.setZero();
  return Rve(s);
}

}  // namespace

Rve agitated(const Rve& rve, double expansion, Uniform& uniform, const DrawWatch& watch) {
  const Scales scales = scales_of(rve.network(), expansion);
  Specimen s = rve.specimen();
  for (Material& material : s.materials) material.friction = material.rolling_friction = 0;
  s.damping = Damping{};
  s.solver = unsteered();
  s.solver.collision_steps = steps_of_collision;
  s.contacts.clear();
  s.state = SolverState{};
  Rve other(s);
  other.watch(watch.stop);
  const int d = other.cell().dimension;
  Matrix3 gradient = Matrix3::Zero();
  gradient.topLeftCorner(d, d).diagonal().setConstant(expansion);
  other.apply(gradient, 0);
  other.relax(1e-3, 200);
  other = moving(other, scales.kinetic_energy, uniform);
  other.watch(watch.stop);
  const double distance = longest_distance * std::min(1.0, expansion / expansion_of_longest);
  const double time = distance * scales.gap / std::sqrt(2 * scales.kinetic_energy / scales.mass);
  for (int k = 0; k < parts; ++k) {
    watch.at("agitating the grains", double(k) / parts);
    other.apply(Matrix3::Zero(), time / parts);
  }
  other.zero_velocities();
  return other;
}

}  // namespace rvelab::pack
