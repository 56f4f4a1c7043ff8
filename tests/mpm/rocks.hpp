// Rocks as tests set them up.
#pragma once

#include "tests/mpm/blocks.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm::test {

/// Adds a rock of that shape and density (kg/m^3), of the first material.
template <int D>
Rock<D>& add_rock(Rocks<D>& rocks, const RockShape<D>& shape, double density, const Vec<D>& centre,
                  const Vec<D>& velocity = Vec<D>::Zero()) {
  Rock<D> rock;
  rock.shape = int(rocks.shapes.size());
  rocks.shapes.push_back(shape);
  rock.body.mass = density * shape.volume() * (D == 2 ? rocks.thickness : 1);
  rock.body.inertia = density * shape.inertia() * (D == 2 ? rocks.thickness : 1);
  rock.body.centre = centre;
  rock.body.velocity = velocity;
  rocks.all.push_back(rock);
  return rocks.all.back();
}

/// Soil with these rocks in it.
template <int D>
void put_rocks(Solver<D>& solver, std::unique_ptr<Rocks<D>> rocks) {
  solver.rocks = std::move(rocks);
  for (const auto& point : solver.points) {
    solver.rocks->add_ball(point, ghost_radius<D>(point, solver.rocks->soil.porosity), false);
  }
  solver.rocks->first_energy = 0;
  solver.rocks->first_energy = solver.rocks->energy(solver.options.gravity).residual;
}

template <int D>
Vec<D> momentum_of(const Rocks<D>& rocks) {
  Vec<D> sum = Vec<D>::Zero();
  for (const auto& rock : rocks.all) sum += rock.body.mass * rock.body.velocity;
  return sum;
}

}  // namespace mpm::test
