// Energies and momentum of all points, added in the order of the points.
#pragma once

#include "tools/mpm/solver.hpp"

namespace mpm {

/// J. Since the start: kinetic + potential + stress_work + mapping_loss = boundary_work + pressure_work + residual. The
/// residual is the error of the time integration and, once a body touches soil, that of contact at nodes (bodies.hpp).
template <int D>
struct EnergyBalance {
  double kinetic = 0;        ///< of the points, now
  double potential = 0;      ///< change in gravity
  double stress_work = 0;    ///< of the stress in the points
  double pressure_work = 0;  ///< of the pressure on free surfaces
  double boundary_work = 0;  ///< of planes and bodies, on the soil
  double mapping_loss = 0;   ///< between points and nodes (PIC, lumping)
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
  balance.pressure_work = solver.options.surface_pressure * (start.volume - volume);
  balance.mapping_loss = start.kinetic + solver.nodal_kinetic - balance.kinetic;
  balance.residual = balance.kinetic - start.kinetic + balance.potential + balance.stress_work + balance.mapping_loss -
                     balance.boundary_work - balance.pressure_work;
  return balance;
}

}  // namespace mpm
