// Saturated blocks for tests: an elastic block with pore water, no scene.
#pragma once

#include "tests/mpm/blocks.hpp"
#include "tools/mpm/water/fluid.hpp"

namespace mpm::test {

/// The sand of Liang et al. 2023, section 4.1: K 10.98, G 10.57 MPa, porosity 0.161.
constexpr double sand_bulk = 10.98e6, sand_shear = 10.57e6, sand_modulus = sand_bulk + 4 * sand_shear / 3;
constexpr double sand_porosity = 0.161, solids = 2650, water_density = 1000;
inline ElasticModuli sand_moduli() {
  return {9 * sand_bulk * sand_shear / (3 * sand_bulk + sand_shear),
          (3 * sand_bulk - 2 * sand_shear) / (2 * (3 * sand_bulk + sand_shear))};
}

/// Walls are impermeable unless `open` says (in the order of `planes`); free surfaces are drained unless told.
template <int D>
std::unique_ptr<Solver<D>> saturated(const std::array<int, D>& cells, double cell, double conductivity,
                                     const std::vector<Plane<D>>& planes, bool drained_surface = true,
                                     const std::vector<WaterBoundary>& open = {}, int threads = 1) {
  auto solver = block<D>(cells, cell, sand_moduli(), (1 - sand_porosity) * solids, threads);
  solver->planes.all = planes;
  auto fluid = std::make_unique<Fluid<D>>();
  fluid->options.drained_surface = drained_surface;
  fluid->options.boundaries = open;
  fluid->options.boundaries.resize(planes.size());
  for (const auto& point : solver->points) {
    FluidPoint<D> here;
    here.solids = (1 - sand_porosity) * point.volume;
    here.first_void_ratio = sand_porosity / (1 - sand_porosity);
    here.conductivity = conductivity;
    fluid->points.push_back(here);
  }
  make_water_boundaries<D>(solver->planes, solver->bodies, *fluid);
  solver->fluid = std::move(fluid);
  return solver;
}

template <int D>
Vec<D> total_momentum(const Solver<D>& solver) {
  Vec<D> sum = momentum_of<D>(solver);
  for (const auto& point : solver.fluid->points) sum += point.mass * point.velocity;
  return sum;
}

}  // namespace mpm::test
