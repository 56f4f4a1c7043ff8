// Saturated elastic soil against exact solutions. [.saturated]: the bars of tools/validate mpm_fluid, in full.
#include "tests/mpm/saturated_cases.hpp"

using namespace mpm;
using namespace mpm::test;

TEST_CASE("Soil consolidates as the exact series of the equations of both phases") {
  check(consolidation(25, {0.041, 0.21}));
}

TEST_CASE("In space soil consolidates as in the plane, over any number of threads") {
  constexpr int cells = 20;
  const auto exact = column_of(1e-3);
  const double time = 0.1 / exact.consolidation();
  std::vector<double> base;
  for (const int threads : {1, 3}) {
    auto solver = saturated<3>({1, 1, cells}, 1.0 / cells, 1e-3,
                               {roller<3>(0, 0, true), roller<3>(0, 1, false), roller<3>(1, 0, true),
                                roller<3>(1, 1, false), roller<3>(2, 0, true)},
                               true, {}, threads);
    solver->options.surface_pressure = 1e4;
    solver->fluid->options.follows_void_ratio = false;
    while (solver->time < time) solver->step(std::min(solver->stable_step(), time - solver->time));
    base.push_back(pressure_at<3>(*solver, {0, 0, 0}) / 1e4);
    CHECK(base.back() == Approx(exact.pressure(0, time)).margin(0.01));
    CHECK(pressure_at<3>(*solver, {1, 1, cells / 2}) / 1e4 == Approx(exact.pressure(0.5, time)).margin(0.01));
  }
  CHECK(base[0] == base[1]);
}

namespace {

/// Pa at the base and half way up of a column along the last axis, with these sides, at T = 0.05.
template <int D>
std::array<double, 2> pressures_between(const std::array<int, D>& cells, const std::vector<Plane<D>>& sides) {
  std::vector<Plane<D>> planes = sides;
  planes.push_back(roller<D>(D - 1, 0, true));
  auto solver = saturated<D>(cells, 1.0 / cells[D - 1], 1e-3, planes);
  solver->options.surface_pressure = 1e4;
  solver->fluid->options.follows_void_ratio = false;
  const double time = 0.05 / column_of(1e-3).consolidation();
  while (solver->time < time) solver->step(std::min(solver->stable_step(), time - solver->time));
  typename Grid<D>::Index base{}, middle{};
  middle[D - 1] = cells[D - 1] / 2;
  return {pressure_at<D>(*solver, base), pressure_at<D>(*solver, middle)};
}

template <int D>
std::vector<Plane<D>> walls(int axis, int cells) {
  return {roller<D>(axis, 0, true), roller<D>(axis, cells, false)};
}

template <int D>
std::vector<Plane<D>> periodic_sides(int axis, int cells) {
  Plane<D> plane = roller<D>(axis, 0, true);
  plane.period = cells;
  return {plane};
}

template <int D>
std::vector<Plane<D>> together(std::vector<Plane<D>> sides, const std::vector<Plane<D>>& more) {
  sides.insert(sides.end(), more.begin(), more.end());
  return sides;
}

}  // namespace

TEST_CASE("A column between periodic sides consolidates as one between smooth walls") {
  for (const int wide : {1, 3, 6}) {
    const auto plane = pressures_between<2>({wide, 10}, walls<2>(0, wide));
    const auto periodic = pressures_between<2>({wide, 10}, periodic_sides<2>(0, wide));
    const auto space = pressures_between<3>({wide, 2, 10}, together(walls<3>(0, wide), walls<3>(1, 2)));
    const auto along_x = pressures_between<3>({wide, 2, 10}, together(periodic_sides<3>(0, wide), walls<3>(1, 2)));
    const auto along_y = pressures_between<3>({2, wide, 10}, together(walls<3>(0, 2), periodic_sides<3>(1, wide)));
    const auto both =
        pressures_between<3>({wide, 2, 10}, together(periodic_sides<3>(0, wide), periodic_sides<3>(1, 2)));
    CAPTURE(wide);
    CHECK(plane[0] > 9e3);
    CHECK(plane[1] < plane[0]);
    for (const int at : {0, 1}) {
      for (const double other : {periodic[at], space[at], along_x[at], along_y[at], both[at]}) {
        CHECK(other == Approx(plane[at]).epsilon(1e-9));
      }
    }
  }
}

TEST_CASE("Pressure waves in saturated soil have the speeds of both phases") { check(pressure_waves(40)); }

TEST_CASE("Shear waves carry the water along where it cannot move, and leave it where nothing drags it") {
  check(shear_waves(20));
}

TEST_CASE("Layers under water rest, and hold the weight of the water as pressure") { check(hydrostatic(10)); }

TEST_CASE("Seepage follows Darcy's law, and lifts the soil at the critical gradient") { check(seepage(10)); }

TEST_CASE("Where nothing drains the water takes the load and the volume stays") {
  check(undrained_block(4));
  check(sealed_box(4));
}

TEST_CASE("Pressure and drag within saturated soil leave its momentum") { check(momentum(5)); }

TEST_CASE("A point without room for water ends the run, and says where") {
  auto solver = loaded_column(4, 1e-3);
  solver->fluid->points[3].solids = solver->points[3].volume;
  CHECK_THROWS_WITH(solver->step(solver->stable_step()), Catch::Matchers::Contains("no room for water"));
}

TEST_CASE("Nearly undrained pressure does not alternate under a strip load") { check(strip(12)); }

TEST_CASE("In full: rest, seepage, undrained", "[.saturated]") {
  check(hydrostatic(20), true);
  check(seepage(20), true);
  check(undrained_block(4), true);
  check(undrained_block(10), true);
  check(sealed_box(10), true);
  check(momentum(10), true);
  check(strip(20), true);
}

TEST_CASE("In full: consolidation", "[.saturated]") {
  check(consolidation(50, {0.010, 0.041, 0.10, 0.21, 0.31, 0.52, 0.72, 1.02}), true);
  check(conductivities(50), true);
  const auto ringing = column_of(1e-2);
  auto solver = loaded_column(50, 1e-2);
  for (const double T : {0.10, 0.52, 1.02}) {
    const double time = T / ringing.consolidation();
    run_to(*solver, time);
    check({{named("k = 1e-2, inertia rings: U at T = %g", T), settlement(*solver, 1e4) * sand_modulus / 1e4,
            ringing.degree(time), 0.005}},
          true);
  }
  const double coarse = consolidation_error(25), fine = consolidation_error(50), finest = consolidation_error(100);
  check({{"h and dt halved: error of p falls, 25 to 50 cells", coarse / fine, 1.8, NAN},
         {"h and dt halved: error of p falls, 50 to 100 cells", fine / finest, 1.8, NAN}},
        true);
}

TEST_CASE("In full: waves", "[.saturated]") {
  check(pressure_waves(50), true);
  check(shear_waves(20), true);
  check(damped_wave(50), true);
}
