#include "tools/mpm/step/watch.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <sstream>

#include "tools/mpm/error.hpp"

namespace mpm {
namespace {

template <int D>
std::string place_of(const Point<D>& point) {
  return in_words(std::vector<double>(point.position.data(), point.position.data() + D)) + " m";
}

/// The cause of the time step of Solver::stable_step: the fastest wave, the fastest point, or a driven boundary or
/// body.
template <int D>
std::string cause_of_step(const Solver<D>& solver) {
  double wave = 0, fastest = 0, driven = 0;
  std::string of_wave, of_point, of_driven;
  for (const auto& group : solver.groups) {
    for (long k = group.first; k < group.first + group.count; ++k) {
      const auto& point = solver.points[std::size_t(k)];
      const double modulus = group.material->wave_modulus(), density = point.mass / point.volume;
      const double speed = std::sqrt(modulus / density), own = point.velocity.norm();
      if (!(speed <= wave)) {
        wave = speed;
        of_wave = "the wave of material " + group.name + ", " + in_words(speed) + " m/s, at its point at " +
                  place_of<D>(point) + " (modulus " + in_words(modulus) + " Pa, density " + in_words(density) +
                  " kg/m^3)";
      }
      if (!(own <= fastest)) {
        fastest = own;
        of_point = "the point of material " + group.name + " at " + place_of<D>(point) + ", which moves at " +
                   in_words(own) + " m/s";
      }
    }
  }
  const auto drive = [&](const std::string& name, const auto& each) {
    const double speed = each.velocity_at(solver.time).norm();
    if (speed <= driven) return;
    driven = speed;
    of_driven = name + ", which moves at " + in_words(speed) + " m/s";
  };
  for (const auto& plane : solver.planes.all) drive("boundary." + plane.name, plane);
  for (const auto& body : solver.bodies.all) drive("body." + body.name, body);
  for (std::size_t k = 0; solver.rocks && k < solver.rocks->all.size(); ++k) {
    const double speed = solver.rocks->surface_speed(solver.rocks->all[k]);
    if (speed <= driven) continue;
    driven = speed;
    of_driven = "rock " + std::to_string(k) + " (" + solver.rocks->all[k].name + "), whose surface moves at " +
                in_words(speed) + " m/s";
  }
  if (solver.points.empty()) {
    return (driven > 0 ? of_driven : "gravity of " + in_words(solver.options.gravity.norm()) + " m/s^2") +
           ", in cells of " + in_words(solver.grid.cell.minCoeff()) + " m";
  }
  const double own = solver.options.cfl / (wave + fastest);
  if (driven > 0 && 0.2 / driven < own) return of_driven;
  return (wave >= fastest ? of_wave : of_point) + ", in cells of " + in_words(solver.grid.cell.minCoeff()) + " m";
}

/// J, a scale for residuals: energy that the stress of the soil stores, at strains up to a hundredth; round-off of
/// heights in gravity; with contact at nodes, which is sharp to a cell, the weight over the height of a cell.
template <int D>
double stored_energy(const Solver<D>& solver) {
  constexpr double most = 0.01, least = 1e-5, round_off = 1e-10;
  const bool at_nodes = std::any_of(solver.bodies.all.begin(), solver.bodies.all.end(),
                                    [](const auto& body) { return !body.at_surface; });
  double sum = 1e-300;
  for (const auto& group : solver.groups) {
    const double modulus = group.material->wave_modulus();
    for (long k = group.first; k < group.first + group.count; ++k) {
      const auto& point = solver.points[std::size_t(k)];
      const double stress = point.stress.norm(), strain = stress / modulus;
      sum += 0.5 * point.volume * (stress * std::min(strain, most) + modulus * least * least);
      sum += round_off * point.mass * std::abs(solver.options.gravity.dot(point.position));
      if (at_nodes) sum += point.mass * solver.options.gravity.cwiseProduct(solver.grid.cell).norm();
    }
  }
  return sum;
}

}  // namespace

template <int D>
void watch_step(const Solver<D>& solver, double dt, Watched& seen, std::ostream& tell) {
  if (seen.first_step == 0) seen.first_step = dt;
  if (dt >= warning_step * seen.first_step) return;
  const std::string words = "at " + in_words(solver.time) + " s the time step is " + in_words(dt) +
                            " s, and the first was " + in_words(seen.first_step) + " s; ";
  // A step that is not a number comes here too.
  if (!(dt >= ending_step * seen.first_step)) {
    throw std::runtime_error(words + "the run would stand still: it ends. What asks for it: " +
                             cause_of_step<D>(solver) + "; is the soil too soft for its load?");
  }
  if (seen.warned_step) return;
  seen.warned_step = true;
  tell << "rvelab-mpm: " << words << "what asks for it: " << cause_of_step<D>(solver) << std::endl;
}

template <int D>
void watch_length(const Solver<D>& solver, double dt, double sub_steps, double duration) {
  const double left = duration - solver.time, steps = left / dt * sub_steps;
  if (steps <= most_steps) return;
  std::string words = "at " + in_words(solver.time) + " s the time step is " + in_words(dt / sub_steps) + " s" +
                      (sub_steps > 1 ? " (of the contacts of rocks)" : "") + ", and the " + in_words(left) +
                      " s to time.duration_s would need " + in_words(steps) + " steps; allowed: up to " +
                      in_words(most_steps) + ". ";
  words += sub_steps > 1 ? "What asks for it: the stiffest contact of rocks; make rocks larger or softer"
                         : "What asks for it: " + cause_of_step<D>(solver) + "; make material softer, or cells larger";
  words += ", or time.duration_s shorter";
  if (solver.steps == 0) throw InputError(words);
  throw std::runtime_error(words + "; the run would stand still: it ends");
}

template <int D>
void watch_energy(const Solver<D>& solver, const EnergyStart& start, Watched& seen, std::ostream& tell) {
  const auto b = energy_balance<D>(solver, start);
  for (const double energy : {b.kinetic, start.kinetic, b.potential, b.stress_work, b.pressure_work, b.boundary_work,
                              b.load_work, b.drag_loss, b.water_work, b.water_gravity, stored_energy<D>(solver)}) {
    seen.energy = std::max(seen.energy, std::abs(energy));
  }
  if (solver.rocks) {
    // What rocks bring, and their weight over a twentieth of a cell: contact is found that early.
    const auto rocks = solver.rocks->energy(solver.options.gravity);
    double weight = 0;
    for (const auto& rock : solver.rocks->all) weight += rock.body.mass * solver.options.gravity.norm();
    for (const double energy : {rocks.kinetic, rocks.soil_work, 0.05 * weight * solver.grid.cell.minCoeff()}) {
      seen.energy = std::max(seen.energy, std::abs(energy));
    }
  }
  // Mapping may lose energy; what it gains comes from nothing too.
  const double nothing = std::abs(b.residual) + std::max(0.0, -b.mapping_loss);
  const double share = nothing / seen.energy, start_up = 4 / double(std::max(1L, solver.steps));
  if (share < warning_share + start_up) return;
  std::ostringstream words;
  words.precision(3);
  words << "at " << solver.time << " s " << nothing << " J are not accounted for, " << 100 * share
        << " % of the largest energy so far";
  // A share that is not a number comes here too.
  if (!(share < ending_share + start_up)) {
    throw std::runtime_error(
        words.str() + " (allowed: " + in_words(100 * ending_share) +
        "): the run ends; take a smaller time.cfl or grid.cell_m, or a load that the soil can carry");
  }
  if (seen.warned_energy) return;
  seen.warned_energy = true;
  tell << "rvelab-mpm: " << words.str() << " (the run ends at " << 100 * ending_share
       << "); take a smaller time.cfl or grid.cell_m" << std::endl;
}

template void watch_step<2>(const Solver<2>&, double, Watched&, std::ostream&);
template void watch_step<3>(const Solver<3>&, double, Watched&, std::ostream&);
template void watch_length<2>(const Solver<2>&, double, double, double);
template void watch_length<3>(const Solver<3>&, double, double, double);
template void watch_energy<2>(const Solver<2>&, const EnergyStart&, Watched&, std::ostream&);
template void watch_energy<3>(const Solver<3>&, const EnergyStart&, Watched&, std::ostream&);

}  // namespace mpm
