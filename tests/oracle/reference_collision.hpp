// LAMMPS' recorded collisions of two and three spheres (tests/data/lammps/micro), run by an Rve.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "rvelab/solver/rve.hpp"
#include "tests/oracle/reference_table.hpp"

namespace rvelab::test {

/// Largest differences from the record, and what the record itself reaches.
struct CollisionDifference {
  double force = 0, torque = 0;   ///< N, N m
  double position = 0;            ///< m
  double velocity = 0, spin = 0;  ///< m/s, rad/s
  double largest_force = 0;       ///< N
  double largest_torque = 0;      ///< N m
  std::size_t rows = 0;
};

inline Vector3 vector_from(const nlohmann::json& three) {
  return {three.at(0).get<double>(), three.at(1).get<double>(), three.at(2).get<double>()};
}

/// The spheres of a record in a cell so wide that no image is near, with the record's law, dashpot and time step.
inline Specimen collision_specimen(const nlohmann::json& record) {
  Specimen s;
  s.shape = Shape::sphere;
  s.cell = cubic_cell(3, 8.0);
  s.contact.slip = Slip::full_radius;
  s.solver.fixed_time_step = record.at("dt");
  const auto& model = record.at("model");
  Material m;
  m.friction = model.at("mu");
  const std::string normal = model.at("normal"), dashpot = model.at("normal_damping");
  if (normal == "hertz/material") {
    s.contact.law = Law::hertz_mindlin;
    m.young_modulus = model.at("E");
    m.poisson_ratio = model.at("nu");
  } else {
    s.contact.law = normal == "hooke" ? Law::linear_stiffness : Law::hertz_stiffness;
    m.normal_stiffness = model.at(normal == "hooke" ? "kn" : "k");
    m.tangential_stiffness = model.at("kt");
  }
  s.damping.tangential_ratio = model.at("x_gamma_t");
  if (dashpot == "velocity") {
    s.damping.dashpot = Dashpot::coefficient;
    s.damping.normal_coefficient = model.at("c_n");
  } else if (dashpot == "viscoelastic") {
    s.damping.dashpot = Dashpot::viscoelastic;
    s.damping.normal_coefficient = model.at("eta_n");
  } else {
    s.damping.dashpot = Dashpot::tsuji;
    s.damping.restitution = model.at("eta_n");
  }
  for (const auto& sphere : record.at("spheres")) {
    m.density = sphere.at("rho");
    s.grains.id.push_back(std::int64_t(s.grains.id.size()) + 1);
    s.grains.radius.push_back(sphere.at("r"));
    s.grains.material.push_back(0);
    s.grains.position.push_back(vector_from(sphere.at("x")));
    s.grains.velocity.push_back(vector_from(sphere.at("v")));
    s.grains.spin.push_back(vector_from(sphere.at("w")));
  }
  s.materials = {m};
  s.state.last_step.loading = Loading::at_rate;
  return s;
}

/// Torques on the grains, N m, from the forces of a network: each acts at the middle of the overlap.
inline std::vector<Vector3> torques(const Network& network) {
  std::vector<Vector3> torque(network.grains.size(), Vector3::Zero());
  for (const auto& c : network.contacts) {
    const Vector3 turn = c.normal.cross(c.tangential_force);
    torque[c.i] -= (network.grains[c.i].radius - 0.5 * c.overlap) * turn;
    torque[c.j] -= (network.grains[c.j].radius - 0.5 * c.overlap) * turn;
  }
  return torque;
}

/// Sets velocities and spins so that the next step moves the spheres with exactly these.
inline void set_motion(Rve& rve, const std::vector<Vector3>& velocity, const std::vector<Vector3>& spin, double dt) {
  // The step adds dt f/m before it moves the spheres: taken off beforehand, they move as prescribed. The dashpot makes
  // f depend on what is set; each round gains five digits.
  std::vector<Vector3> v = velocity, w = spin;
  for (int round = 0; round < 4; ++round) {
    rve.set_velocities(v, w);
    const Network network = rve.network();
    const auto torque = torques(network);
    for (std::size_t g = 0; g < v.size(); ++g) {
      v[g] = velocity[g] - dt / network.grains[g].mass * network.grains[g].resultant;
      w[g] = spin[g] - dt / network.grains[g].inertia * torque[g];
    }
  }
  rve.set_velocities(v, w);
}

inline void compare_row(const RecordedTable& record, std::size_t row, const Rve& rve, const Vector3& shift,
                        const Vector3& drift, bool prescribed, CollisionDifference& worst) {
  const Network network = rve.network();
  const auto torque = torques(network);
  const double dt = rve.specimen().solver.fixed_time_step;
  for (std::size_t g = 0; g < network.grains.size(); ++g) {
    const std::string id = std::to_string(g + 1);
    const GrainState& grain = network.grains[g];
    const Vector3 force = record.vector(row, "f", id), turn = record.vector(row, "t", id);
    worst.largest_force = std::max(worst.largest_force, force.norm());
    worst.largest_torque = std::max(worst.largest_torque, turn.norm());
    worst.force = std::max(worst.force, (grain.resultant - force).norm());
    worst.torque = std::max(worst.torque, (torque[g] - turn).norm());
    worst.position = std::max(worst.position, (grain.position + shift - record.vector(row, "", id)).norm());
    if (prescribed) continue;
    // Leapfrog: velocities are those of half a step before, forces and positions those of the row.
    const Vector3 velocity = grain.velocity + 0.5 * dt / grain.mass * grain.resultant + drift;
    const Vector3 spin = grain.spin + 0.5 * dt / grain.inertia * torque[g];
    worst.velocity = std::max(worst.velocity, (velocity - record.vector(row, "v", id)).norm());
    worst.spin = std::max(worst.spin, (spin - record.vector(row, "w", id)).norm());
  }
  ++worst.rows;
}

/// Runs a record of LAMMPS and compares every row. The periodic cell carries no total momentum: the record is looked
/// at from its centre of mass. `nudge` (m) is added to x of the first sphere.
inline CollisionDifference compare_with_record(const std::string& name, double nudge) {
  const nlohmann::json parameters = recorded_json("lammps/micro/params.json").at(name);
  const RecordedTable record("lammps/micro/" + name + ".csv");
  Specimen specimen = collision_specimen(parameters);
  const double dt = specimen.solver.fixed_time_step;
  const bool prescribed = parameters.at("prescribed");
  Grains& grains = specimen.grains;
  Vector3 drift = Vector3::Zero();
  double mass = 0;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const double share = grains.radius[g] * grains.radius[g] * grains.radius[g];
    drift += share * grains.velocity[g];
    mass += share;
  }
  drift /= mass;
  for (auto& v : grains.velocity) v -= drift;
  grains.position[0][0] += nudge;

  CollisionDifference worst;
  Rve rve(specimen);
  std::size_t row = 0;
  long step = 0;
  const auto compare_if_recorded = [&](const Vector3& shift) {
    if (row < record.rows() && long(record.at(row, "step")) == step)
      compare_row(record, row++, rve, shift, drift, prescribed, worst);
  };
  compare_if_recorded(Vector3::Zero());
  if (!prescribed) {
    while (row < record.rows()) {
      const long next = long(record.at(row, "step"));
      rve.apply(Matrix3::Zero(), double(next - step) * dt);
      step = next;
      compare_if_recorded(double(step) * dt * drift);
    }
    return worst;
  }
  std::vector<Vector3> velocity(grains.size(), Vector3::Zero()), spin = velocity;
  Vector3 middle = Vector3::Zero();
  for (const auto& segment : parameters.at("segments")) {
    for (const auto& [id, six] : segment.at("set_velocity_spin").items()) {
      const auto g = std::size_t(std::stol(id) - 1);
      velocity[g] = {six.at(0).get<double>(), six.at(1).get<double>(), six.at(2).get<double>()};
      spin[g] = {six.at(3).get<double>(), six.at(4).get<double>(), six.at(5).get<double>()};
    }
    Vector3 mean = Vector3::Zero();  // equal spheres
    for (const auto& v : velocity) mean += v / double(velocity.size());
    auto relative = velocity;
    for (auto& v : relative) v -= mean;
    for (long k = 0; k < long(segment.at("steps")); ++k) {
      set_motion(rve, relative, spin, dt);
      rve.apply(Matrix3::Zero(), dt);
      middle += dt * mean;
      ++step;
      compare_if_recorded(middle);
    }
  }
  return worst;
}

}  // namespace rvelab::test
