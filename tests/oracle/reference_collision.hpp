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
    s.contact.law = normal == "hooke" ? Law::linear_given : Law::hertz_given;
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
    s.damping.dashpot = Dashpot::restitution;
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
  s.state.quasi_static = false;
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

/// Runs a record of LAMMPS and compares every row. The periodic cell carries no total momentum: the record is looked
/// at from its centre of mass. `nudge` (m) is added to x of the first sphere.
CollisionDifference compare_with_record(const std::string& name, double nudge);

}  // namespace rvelab::test
