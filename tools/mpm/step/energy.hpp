// Energies and momentum of all points, added in the order of the points.
#pragma once

#include "tools/mpm/step/solver.hpp"

namespace mpm {

/// J. Since the start: kinetic + potential + stress_work + mapping_loss = boundary_work + pressure_work + residual;
/// with pore water, kinetic energy, mapping and boundaries are those of both phases, drag_loss is on the left and
/// water_work and water_gravity on the right; so is load_work where loads change with time. The residual is what
/// the time integration leaves besides (MUSL more than USF) and, once a body touches soil, the error of contact at
/// nodes (bodies.hpp); steps too long for their material show as a mapping loss below 0.
template <int D>
struct EnergyBalance {
  double kinetic = 0;        ///< of the points, now
  double potential = 0;      ///< change in gravity
  double stress_work = 0;    ///< of the stress in the points
  double pressure_work = 0;  ///< of the pressure on free surfaces
  double boundary_work = 0;  ///< of planes, bodies and rocks, on the soil
  double mapping_loss = 0;   ///< between points and nodes (PIC, lumping), with the stress's half step (solver.hpp)
  double load_work = 0;      ///< of shaking and strips
  double drag_loss = 0;      ///< between soil and water
  double water_work = 0;     ///< of the pore pressure on both: what came in at given pressures, or was stored
  double water_gravity = 0;  ///< work of gravity on the water
  double residual = 0;
  Vec<D> momentum = Vec<D>::Zero();
};

/// The state that an energy balance starts from.
struct EnergyStart {
  double kinetic = 0, potential = 0, volume = 0;
};

template <int D>
EnergyStart energy_start(const Solver<D>& solver) {
  EnergyStart start;
  for (const auto& point : solver.points) {
    start.kinetic += 0.5 * point.mass * point.velocity.squaredNorm();
    start.potential -= point.mass * solver.options.gravity.dot(point.position);
    start.volume += point.volume;
  }
  if (solver.fluid) {
    for (const auto& point : solver.fluid->points) start.kinetic += 0.5 * point.mass * point.velocity.squaredNorm();
  }
  return start;
}

template <int D>
EnergyBalance<D> energy_balance(const Solver<D>& solver, const EnergyStart& start) {
  EnergyBalance<D> balance;
  double volume = 0;
  balance.potential = -start.potential;
  for (const auto& point : solver.points) {
    balance.kinetic += 0.5 * point.mass * point.velocity.squaredNorm();
    balance.potential -= point.mass * solver.options.gravity.dot(point.position);
    balance.stress_work += point.work;
    balance.momentum += point.mass * point.velocity;
    volume += point.volume;
  }
  solver.each_driven([&](const auto& each) { balance.boundary_work += each.reaction.work; });
  if (solver.rocks) balance.boundary_work += solver.rocks->work_on_soil;
  balance.pressure_work = solver.options.surface_pressure * (start.volume - volume);
  double nodal = solver.nodal_energy;
  if (solver.fluid) {
    const auto& water = *solver.fluid;
    for (const auto& point : water.points) {
      balance.kinetic += 0.5 * point.mass * point.velocity.squaredNorm();
      balance.momentum += point.mass * point.velocity;
    }
    for (const auto& plane : water.planes.all) balance.boundary_work += plane.reaction.work;
    for (const auto& body : water.bodies.all) balance.boundary_work += body.reaction.work;
    nodal += water.nodal_energy;
    balance.drag_loss = water.drag_loss;
    balance.water_work = water.water_work;
    balance.water_gravity = water.gravity_work;
  }
  balance.load_work = solver.load_work;
  balance.mapping_loss = start.kinetic + nodal - balance.kinetic;
  balance.residual = balance.kinetic - start.kinetic + balance.potential + balance.stress_work + balance.mapping_loss +
                     balance.drag_loss - balance.boundary_work - balance.pressure_work - balance.load_work -
                     balance.water_work - balance.water_gravity;
  return balance;
}

}  // namespace mpm
