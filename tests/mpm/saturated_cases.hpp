// What saturated soil is held to: measurements with their targets, small in ctest and larger in tools/validate
// mpm_fluid.
#pragma once

#include <cstdio>
#include <string>

#include "tests/catch.hpp"
#include "tests/mpm/saturated.hpp"
#include "tests/oracle/consolidation.hpp"

namespace mpm::test {

struct Bar {
  std::string what;
  double value, target, tolerance;  ///< tolerance NaN: the target is the least that is allowed
  bool passed() const { return std::isnan(tolerance) ? value >= target : std::abs(value - target) <= tolerance; }
};

/// Each must pass; `print`: a line each, for the table.
inline void check(const std::vector<Bar>& bars, bool print = false) {
  for (const auto& bar : bars) {
    char line[200];
    const char* format =
        std::isnan(bar.tolerance) ? "%-72s %10.4g  >= %-24.4g %s" : "%-72s %10.4g  %10.4g +- %-12.2g %s";
    const char* verdict = bar.passed() ? "ok" : "MISSED";
    if (std::isnan(bar.tolerance))
      std::snprintf(line, sizeof line, format, bar.what.c_str(), bar.value, bar.target, verdict);
    else
      std::snprintf(line, sizeof line, format, bar.what.c_str(), bar.value, bar.target, bar.tolerance, verdict);
    if (print) std::printf("%s\n", line);
    INFO(line);
    CHECK(bar.passed());
  }
}

inline std::string named(const char* format, double value) {
  char text[120];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

inline rvelab::oracle::SaturatedColumn column_of(double conductivity) {
  return {sand_porosity, solids, water_density, sand_modulus, conductivity};
}

template <int D>
double pressure_at(const Solver<D>& solver, const typename Grid<D>::Index& node) {
  return solver.fluid->pressure.values[solver.grid.flat(node)];
}

inline void run_to(Solver<2>& solver, double time) {
  while (solver.time < time * (1 - 1e-12)) {
    const double dt = solver.stable_step();
    solver.step(std::min(dt, time - solver.time));
  }
}

/// Settlement of the top of a column of unit height: that of its highest points, and half their distance of strain.
inline double settlement(const Solver<2>& solver, double load) {
  double sum = 0, highest = 0, count = 0;
  for (const auto& point : solver.points) highest = std::max(highest, point.first[1]);
  for (const auto& point : solver.points) {
    if (point.first[1] < highest - 1e-9) continue;
    sum += point.first[1] - point.position[1] + (1 - highest) * load / sand_modulus;
    ++count;
  }
  return sum / count;
}

/// A column of unit height under 10 kPa on its drained top.
inline std::unique_ptr<Solver<2>> loaded_column(int cells, double conductivity, int threads = 1) {
  auto solver = saturated<2>({1, cells}, 1.0 / cells, conductivity,
                             {roller<2>(0, 0, true), roller<2>(0, 1, false), roller<2>(1, 0, true)}, true, {}, threads);
  solver->options.surface_pressure = 1e4;
  solver->fluid->options.follows_void_ratio = false;
  return solver;
}

/// Consolidation against the exact series and Terzaghi's.
inline std::vector<Bar> consolidation(int cells, const std::vector<double>& factors, double conductivity = 1e-3) {
  auto solver = loaded_column(cells, conductivity);
  const auto exact = column_of(conductivity);
  std::vector<Bar> bars;
  for (const double T : factors) {
    const double time = T / exact.consolidation();
    run_to(*solver, time);
    const double U = settlement(*solver, 1e4) * sand_modulus / 1e4, base = pressure_at<2>(*solver, {0, 0}) / 1e4;
    bars.push_back(
        {named("consolidation: U at T = %g, exact u-v-p series", T), U, exact.degree(time), T < 0.02 ? 0.01 : 0.005});
    bars.push_back({named("p/p0 at the base, T = %g, exact u-v-p series", T), base, exact.pressure(0, time), 0.01});
    if (T >= 0.1) bars.push_back({named("U at T = %g, Terzaghi", T), U, rvelab::oracle::terzaghi_degree(T), 0.01});
  }
  return bars;
}

/// Largest error of the pressure (over the load) below the first two cells at T = 0.1.
inline double consolidation_error(int cells) {
  auto solver = loaded_column(cells, 1e-3);
  const auto exact = column_of(1e-3);
  const double time = 0.1 / exact.consolidation();
  run_to(*solver, time);
  double largest = 0;
  for (int j = 0; j < cells - 2; ++j) {
    const double p = pressure_at<2>(*solver, {0, j}) / 1e4;
    largest = std::max(largest, std::abs(p - exact.pressure(double(j) / cells, time)));
  }
  return largest;
}

/// One time step for every conductivity; nearly undrained, where nothing must alternate.
inline std::vector<Bar> conductivities(int cells) {
  std::vector<Bar> bars;
  for (const double k : {1.0, 1e-2, 1e-5, 1e-9}) {
    auto solver = loaded_column(cells, k);
    run_to(*solver, 0.05);
    double speed = 0;
    for (const auto& point : solver->points) speed = std::max(speed, point.velocity.norm());
    bars.push_back({named("k = %g, one step 0.4 h/c: largest speed after 0.05 s, m/s (finite)", k), speed, 0, 1});
  }
  auto solver = loaded_column(cells, 1e-7);
  run_to(*solver, 0.15);
  double largest = 0;
  for (int j = 0; j <= cells - 4; ++j) largest = std::max(largest, std::abs(pressure_at<2>(*solver, {0, j}) / 1e4 - 1));
  bars.push_back({"k = 1e-7, 0.15 s: |p/p0 - 1| from the fourth node down", largest, 0, 0.03});
  bars.push_back(
      {"k = 1e-7, 0.15 s: U", settlement(*solver, 1e4) * sand_modulus / 1e4, column_of(1e-7).degree(0.15), 0.003});
  return bars;
}

/// Half the period of a standing wave: from the first to the second time that its velocity goes through zero.
inline double half_period(Solver<2>& solver, const std::function<double(const Point<2>&)>& shape) {
  double before = 0, then = 0, first = NAN;
  for (int step = 0; step < 100000; ++step) {
    double sum = 0;
    for (const auto& point : solver.points) sum += point.velocity[1] * shape(point);
    if (step > 0 && before * sum < 0) {
      const double zero = then + (solver.time - then) * before / (before - sum);
      if (!std::isnan(first)) return zero - first;
      first = zero;
    }
    before = sum;
    then = solver.time;
    solver.step(solver.stable_step());
  }
  return NAN;
}

/// Speed of the standing wave v_y = sin(pi y/L) in a closed column, v_f = ratio v_s.
inline double closed_wave_speed(int cells, double conductivity, double bulk_modulus, double ratio, double cfl) {
  auto solver =
      saturated<2>({1, cells}, 1.0 / cells, conductivity,
                   {roller<2>(0, 0, true), roller<2>(0, 1, false), roller<2>(1, 0, true), roller<2>(1, cells, false)},
                   true, {{}, {}, {}, {WaterBoundary::Kind::pressure, 0}});
  auto& water = *solver->fluid;
  water.options.bulk_modulus = bulk_modulus;
  water.options.follows_void_ratio = false;
  if (std::isfinite(bulk_modulus)) {
    water.options.boundaries.back() = {};
    make_water_boundaries<2>(solver->planes, solver->bodies, water);
  }
  solver->options.pic_fraction = 0;
  solver->options.cfl = cfl;
  const auto field = [](const Vec<2>& x) { return Vec<2>(0, 1e-4 * std::sin(pi * x[1])); };
  set_velocity<2>(*solver, field);
  for (std::size_t k = 0; k < water.points.size(); ++k) {
    water.points[k].velocity = ratio * solver->points[k].velocity;
    water.points[k].affine = ratio * solver->points[k].affine;
  }
  return 1 / half_period(*solver, [](const Point<2>& p) { return std::sin(pi * p.first[1]); });
}

inline std::vector<Bar> pressure_waves(int cells) {
  const double n = sand_porosity, infinite = std::numeric_limits<double>::infinity();
  const double slow = std::sqrt(sand_modulus / column_of(1).inertia());
  std::vector<Bar> bars;
  bars.push_back({"slow pressure wave, no drag, incompressible, m/s",
                  closed_wave_speed(cells, 1e9, infinite, -(1 - n) / n, 0.4), slow, 0.01 * slow});
  const auto waves = rvelab::oracle::undragged_waves(n, solids, water_density, sand_modulus, 1e8);
  const double cfl = 0.2 * std::sqrt(sand_modulus / ((1 - n) * solids)) / waves.fast;
  bars.push_back({"K_f = 1e8 Pa: fast wave, no drag, m/s", closed_wave_speed(cells, 1e9, 1e8, waves.fast_ratio, cfl),
                  waves.fast, 0.02 * waves.fast});
  bars.push_back({"K_f = 1e8 Pa: slow wave, no drag, m/s", closed_wave_speed(cells, 1e9, 1e8, waves.slow_ratio, cfl),
                  waves.slow, 0.02 * waves.slow});
  const double density = (1 - n) * solids + n * water_density,
               undrained = std::sqrt((sand_modulus + 1e8 / n) / density);
  bars.push_back({"K_f = 1e8 Pa, k = 1e-9: undrained wave, m/s", closed_wave_speed(cells, 1e-9, 1e8, 1, cfl), undrained,
                  0.02 * undrained});
  return bars;
}

/// Shear wave in a box on rollers, v = (sin(pi x) cos(pi y), -cos(pi x) sin(pi y)): no stress on the walls.
inline double shear_wave_speed(int cells, double conductivity, double ratio) {
  auto solver = saturated<2>(
      {cells, cells}, 1.0 / cells, conductivity,
      {roller<2>(0, 0, true), roller<2>(0, cells, false), roller<2>(1, 0, true), roller<2>(1, cells, false)}, true,
      {{}, {}, {}, {WaterBoundary::Kind::pressure, 0}});
  solver->options.pic_fraction = 0;
  solver->fluid->options.follows_void_ratio = false;
  set_velocity<2>(*solver, [](const Vec<2>& x) {
    return Vec<2>(1e-4 * std::sin(pi * x[0]) * std::cos(pi * x[1]), -1e-4 * std::cos(pi * x[0]) * std::sin(pi * x[1]));
  });
  for (std::size_t k = 0; k < solver->points.size(); ++k) {
    solver->fluid->points[k].velocity = ratio * solver->points[k].velocity;
    solver->fluid->points[k].affine = ratio * solver->points[k].affine;
  }
  const double half =
      half_period(*solver, [](const Point<2>& p) { return -std::cos(pi * p.first[0]) * std::sin(pi * p.first[1]); });
  return 1 / half / std::numbers::sqrt2;
}

inline std::vector<Bar> shear_waves(int cells) {
  const double skeleton = (1 - sand_porosity) * solids,
               undrained = std::sqrt(sand_shear / (skeleton + sand_porosity * water_density));
  return {{"shear wave, undrained (k = 1e-9), m/s", shear_wave_speed(cells, 1e-9, 1), undrained, 0.01 * undrained},
          {"shear wave, no drag, m/s", shear_wave_speed(cells, 1e9, 0), std::sqrt(sand_shear / skeleton),
           0.01 * std::sqrt(sand_shear / skeleton)}};
}

/// A wave of 50 Hz down a column of 6 m, k = 1e-2: phase and amplitude of velocity 1 and 2 m below the top.
inline std::vector<Bar> damped_wave(int cells_a_metre) {
  const int cells = 6 * cells_a_metre;
  const double h = 1.0 / cells_a_metre, frequency = 50, k = 1e-2;
  auto solver = saturated<2>({1, cells}, h, k, {roller<2>(0, 0, true), roller<2>(0, 1, false), roller<2>(1, 0, true)});
  solver->fluid->options.follows_void_ratio = false;
  solver->options.pic_fraction = 0;
  TimeHistory history;
  for (int i = 0; i <= 2000; ++i) {
    const double time = i * 1e-4, ramp = std::min(1.0, time * frequency / 2);
    history.times.push_back(time);
    history.values.push_back(1e3 * ramp * std::sin(2 * pi * frequency * time));
  }
  solver->loads.strips.push_back({-1, 1, history, 0, 0});
  std::complex<double> upper, lower;
  const auto nearest = [&](double depth) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < solver->points.size(); ++i) {
      if (std::abs(6 - depth - solver->points[i].first[1]) < std::abs(6 - depth - solver->points[best].first[1]))
        best = i;
    }
    return best;
  };
  const auto a = nearest(1), b = nearest(2);
  while (solver->time < 0.16) {
    const double dt = solver->stable_step();
    solver->step(dt);
    if (solver->time < 0.12) continue;
    const auto turn = std::exp(std::complex<double>(0, -2 * pi * frequency * solver->time)) * dt;
    upper += solver->points[a].velocity[1] * turn;
    lower += solver->points[b].velocity[1] * turn;
  }
  const double apart = solver->points[a].first[1] - solver->points[b].first[1];
  const auto ratio = lower / upper;
  const auto [speed, decay] = rvelab::oracle::slow_wave(column_of(k), frequency);
  const double phase = std::arg(ratio), turns = std::round((2 * pi * frequency * apart / speed + phase) / (2 * pi));
  return {{"slow wave, k = 1e-2, 50 Hz: speed, m/s", 2 * pi * frequency * apart / (2 * pi * turns - phase), speed,
           0.02 * speed},
          {"slow wave, k = 1e-2, 50 Hz: length of decay, m", -apart / std::log(std::abs(ratio)), decay, 0.05 * decay}};
}

/// A column of two layers at rest in buoyant geostatic equilibrium, a second long.
inline std::vector<Bar> hydrostatic(int cells) {
  auto solver = saturated<2>({1, cells}, 1.0 / cells, 1e-3,
                             {roller<2>(0, 0, true), roller<2>(0, 1, false), roller<2>(1, 0, true)});
  solver->options.gravity = Vec<2>(0, -9.81);
  auto& water = *solver->fluid;
  water.first_pressure = [](double y) { return 9810 * std::max(0.0, 1 - y); };
  const double ratios[2] = {0.19, 0.23};  // e of the lower and the upper half
  const auto buoyant = [&](int layer) { return (solids - water_density) / (1 + ratios[layer]) * 9.81; };
  for (std::size_t k = 0; k < solver->points.size(); ++k) {
    auto& point = solver->points[k];
    const double y = point.position[1], e = ratios[y > 0.5];
    point.mass = solids / (1 + e) * point.volume;
    water.points[k].solids = point.volume / (1 + e);
    water.points[k].first_void_ratio = e;
    const double vertical = y > 0.5 ? buoyant(1) * (1 - y) : buoyant(1) * 0.5 + buoyant(0) * (0.5 - y);
    point.stress = -vertical * Mat<2>::Identity();
  }
  run_to(*solver, 1);
  double speed = 0, error = 0;
  for (const auto& point : solver->points) speed = std::max(speed, point.velocity.norm());
  for (int j = 0; j <= cells; ++j) {
    error = std::max(error, std::abs(pressure_at<2>(*solver, {0, j}) - 9810 * (1 - double(j) / cells)));
  }
  return {{"hydrostatic, two layers, 1 s: error of p over that at the base", error / 9810, 0, 0.01},
          {"the same: largest speed, m/s", speed, 0, 1e-4}};
}

/// Upward seepage under a hydraulic gradient i: discharge, and the effective stress at the base.
inline std::vector<Bar> seepage(int cells) {
  std::vector<Bar> bars;
  const double critical = (1 - sand_porosity) * (solids / water_density - 1);
  for (const double part : {0.5, 0.95, 1.05}) {
    const double i = part * critical;
    auto solver = saturated<2>({1, cells}, 1.0 / cells, 1e-3,
                               {roller<2>(0, 0, true), roller<2>(0, 1, false), roller<2>(1, 0, true)}, true,
                               {{}, {}, {WaterBoundary::Kind::head, 1 + i}});
    solver->options.gravity = Vec<2>(0, -9.81);
    auto& water = *solver->fluid;
    water.options.follows_void_ratio = false;
    water.first_pressure = [i](double y) { return 9810 * (1 + i) * std::max(0.0, 1 - y); };
    for (auto& point : solver->points) {
      point.stress = -9810 * (critical - i) * (1 - point.position[1]) * Mat<2>::Identity();
    }
    run_to(*solver, 0.1);
    const double before = water.outflow.back(), base = water.outflow[2], then = solver->time;
    run_to(*solver, 0.2);
    const double area = 1.0 / cells, time = solver->time - then;
    if (part == 0.5) {
      bars.push_back({"seepage: discharge over k i, out of the top",
                      (water.outflow.back() - before) / (area * time * 1e-3 * i), 1, 1e-3});
      bars.push_back({"seepage: discharge over k i, into the base",
                      -(water.outflow[2] - base) / (area * time * 1e-3 * i), 1, 1e-3});
    }
    double lowest = 0, height = 1;
    for (const auto& point : solver->points) {
      if (point.first[1] < height) height = point.first[1], lowest = point.stress(1, 1);
    }
    bars.push_back({named("seepage at %g of the critical gradient 1.384: -sigma'_yy at the base, kPa", part),
                    -lowest / 1e3, 9.81 * (critical - i) * (1 - height), 0.02 * 9.81 * critical});
  }
  return bars;
}

/// Nothing drains: a block under a plate's pressure on all sides takes it as pore pressure (Skempton's B = 1).
inline std::vector<Bar> undrained_block(int cells) {
  auto solver = saturated<2>({cells, cells}, 1.0 / cells, 1e-6, {}, false);
  solver->options.surface_pressure = 1e4;
  for (int k = 0; k < 200; ++k) solver->step(solver->stable_step());
  double sum = 0, volume = 0, strain = 0;
  for (std::size_t k = 0; k < solver->points.size(); ++k) {
    sum += solver->points[k].volume * solver->fluid->points[k].pressure;
    volume += solver->points[k].volume;
    strain = std::max(strain, std::abs(solver->points[k].strain.trace()));
  }
  return {{"undrained block, membrane, 10 kPa on all sides: Skempton's B", sum / volume / 1e4, 1, 0.005},
          {"the same: change of its volume a step, 200 steps", std::abs(volume - 1) / 200, 0, 1e-9},
          {"the same: largest volume strain of a point", strain, 0, 1e-5}};
}

/// A sealed box of compressible water, shaken: its volume stays.
inline std::vector<Bar> sealed_box(int cells) {
  auto solver = saturated<2>({cells, cells}, 1.0 / cells, 1e-3, {});
  enclose<2>(*solver, {cells, cells});
  auto& water = *solver->fluid;
  water.options.boundaries.resize(4);
  water.options.bulk_modulus = 2e9;
  make_water_boundaries<2>(solver->planes, solver->bodies, water);
  solver->loads.shaking = {0, 0.1, 20, {}};
  const auto start = energy_start<2>(*solver);
  for (int k = 0; k < 1000; ++k) solver->step(solver->stable_step());
  double volume = 0;
  for (const auto& point : solver->points) volume += point.volume;
  const auto b = energy_balance<2>(*solver, start);
  const double scale = std::abs(b.stress_work) + b.drag_loss + b.kinetic + std::abs(b.mapping_loss);
  return {{"sealed box, K_f = 2e9 Pa, shaken 1000 steps: change of volume", std::abs(volume - 1), 0, 1e-4},
          {"the same: energy residual over what was turned over", std::abs(b.residual) / scale, 0, 0.02}};
}

/// A free block with random velocities and inner pressure: what the step does to its momentum.
inline std::vector<Bar> momentum(int cells) {
  auto solver = saturated<2>({cells, cells}, 1.0 / cells, 1e-3, {}, false);
  unsigned state = 1;
  const auto next = [&] { return (state = 1664525 * state + 1013904223) / 4294967296.0 - 0.5; };
  for (std::size_t k = 0; k < solver->points.size(); ++k) {
    solver->points[k].velocity = Vec<2>(next(), next());
    solver->fluid->points[k].velocity = Vec<2>(next(), next());
  }
  solver->step(1e-6);  // masses of the water
  double worst = 0;
  for (int step = 0; step < 20; ++step) {
    const auto before = solver->fluid->points;
    Vec<2> mine = momentum_of<2>(*solver);
    double scale = 0;
    solver->step(solver->stable_step());
    for (std::size_t k = 0; k < before.size(); ++k) {
      mine += solver->fluid->points[k].mass * before[k].velocity;
      scale += solver->fluid->points[k].mass * before[k].velocity.norm();
    }
    worst = std::max(worst, (total_momentum<2>(*solver) - mine).norm() / scale);
  }
  return {{"free block: change of momentum a step, over the sum of its parts", worst, 0, 1e-12}};
}

/// A strip load on a block between walls, nearly undrained: what alternates from node to node.
inline std::vector<Bar> strip(int cells) {
  auto solver = saturated<2>({cells, cells}, 1.0 / cells, 1e-9,
                             {roller<2>(0, 0, true), roller<2>(0, cells, false), roller<2>(1, 0, true)});
  solver->loads.strips.push_back({-1, 0.25, {{0}, {1e4}}, 0, 0});
  for (int k = 0; k < 300; ++k) solver->step(solver->stable_step());
  double worst = 0;
  for (int j = 1; j < cells - 2; ++j) {
    for (int i = 1; i < cells; ++i) {
      double sum = 0;
      for (int b = -1; b <= 1; ++b) {
        for (int a = -1; a <= 1; ++a) {
          const double weight = (a == 0 ? 0.5 : -0.25) * (b == 0 ? 0.5 : -0.25);
          sum += weight * pressure_at<2>(*solver, {i + a, j + b});
        }
      }
      worst = std::max(worst, std::abs(sum) / 1e4);
    }
  }
  return {{"strip of 10 kPa, k = 1e-9: checkerboard part of p over the load", worst, 0, 0.01}};
}

}  // namespace mpm::test
