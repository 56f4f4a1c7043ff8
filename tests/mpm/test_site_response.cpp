// Soil between periodic sides on an absorbing base: waves that go through it, leave it, and come up into it.
#include "tests/mpm/saturated_cases.hpp"

using namespace mpm;
using namespace mpm::test;

namespace {

Plane<2> periodic(int axis, int cells) {
  Plane<2> plane = roller<2>(axis, 0, true);
  plane.period = cells;
  return plane;
}

Plane<2> absorbing(double impedance, const std::function<double(double)>& incoming = {}, double until = 0) {
  Plane<2> plane = roller<2>(1, 0, true);
  plane.impedance = impedance;
  for (double time = 0; incoming && time <= until; time += 1e-4 * until) {
    plane.incoming.times.push_back(time);
    plane.incoming.velocities.push_back(Vec<2>(incoming(time), 0));
  }
  return plane;
}

constexpr double density = (1 - sand_porosity) * solids;
const double shear_speed = std::sqrt(sand_shear / density);

double kinetic(const Solver<2>& solver) {
  double sum = 0;
  for (const auto& point : solver.points) sum += 0.5 * point.mass * point.velocity.squaredNorm();
  return sum;
}

/// Largest velocity of the top in the second half of a long harmonic motion, over that of the incoming wave.
double amplification(std::unique_ptr<Solver<2>> solver, double frequency, double impedance, double until) {
  solver->options.pic_fraction = 0;
  solver->planes.all = {periodic(0, 1), absorbing(
                                            impedance,
                                            [&](double time) {
                                              const double ramp = std::min(1.0, time * frequency / 3);
                                              return 1e-3 * ramp * std::sin(2 * pi * frequency * time);
                                            },
                                            until)};
  if (solver->fluid) make_water_boundaries<2>(solver->planes, solver->bodies, *solver->fluid);
  double highest = 0, largest = 0;
  for (const auto& point : solver->points) highest = std::max(highest, point.first[1]);
  while (solver->time < until * 0.999) {
    solver->step(solver->stable_step());
    if (solver->time < 0.5 * until) continue;
    for (const auto& point : solver->points) {
      if (point.first[1] > highest - 1e-9) largest = std::max(largest, std::abs(point.velocity[0]));
    }
  }
  return largest / 1e-3;
}

/// Of a layer on a half-space, against the incoming wave: 2/|cos kH + i (Z_1/Z_2) sin kH|.
double exact_amplification(double frequency, double height, double speed, double impedance_ratio) {
  const double phase = 2 * pi * frequency * height / speed;
  return 2 / std::abs(std::complex<double>(std::cos(phase), impedance_ratio * std::sin(phase)));
}

}  // namespace

TEST_CASE("A shear wave leaves through an absorbing base of the soil's impedance, and half of another comes back") {
  for (const double ratio : {1.0, 3.0}) {
    auto solver = block<2>({1, 160}, 0.125, sand_moduli(), density);
    solver->options.pic_fraction = 0;
    solver->planes.all = {periodic(0, 1), absorbing(ratio * density * shear_speed)};
    set_velocity<2>(*solver,
                    [](const Vec<2>& x) { return Vec<2>(1e-3 * std::exp(-std::pow((x[1] - 10) / 1.5, 2)), 0); });
    const auto start = energy_start<2>(*solver);
    run_to(*solver, 32 / shear_speed);  // down and out; up, back from the top, down and out
    const double back = std::pow((ratio - 1) / (ratio + 1), 2);
    const auto balance = energy_balance<2>(*solver, start);
    CHECK(2 * kinetic(*solver) / start.kinetic == Approx(back).margin(0.01));
    CHECK(-balance.boundary_work / start.kinetic == Approx(1 - back).margin(0.01));
    CHECK(std::abs(balance.residual) / start.kinetic < 0.01);
  }
}

TEST_CASE("A layer on a half-space amplifies what comes up as its transfer function, dry and saturated") {
  const double height = 5, half_space = 3 * density * shear_speed;
  for (const double frequency : {3.0, 5.5, 9.0}) {
    CAPTURE(frequency);
    CHECK(
        amplification(block<2>({1, 40}, 0.125, sand_moduli(), density), frequency, half_space, 20 / frequency) ==
        Approx(exact_amplification(frequency, height, shear_speed, density * shear_speed / half_space)).epsilon(0.03));
  }
  const double heavy = density + sand_porosity * water_density, slow = std::sqrt(sand_shear / heavy);
  CHECK(amplification(saturated<2>({1, 20}, 0.25, 1e-9, {periodic(0, 1), absorbing(half_space)}), 5.5, half_space,
                      12 / 5.5) ==
        Approx(exact_amplification(5.5, height, slow, heavy * slow / half_space)).epsilon(0.03));
}

TEST_CASE("Waves go round between periodic sides with the speeds of the soil and its water") {
  constexpr int cells = 60;
  for (const bool with_water : {false, true}) {
    const std::vector<Plane<2>> planes{periodic(0, cells), roller<2>(1, 0, true), roller<2>(1, 2, false)};
    auto solver = with_water ? saturated<2>({cells, 2}, 1.0 / cells, 1e-9, planes)
                             : block<2>({cells, 2}, 1.0 / cells, sand_moduli(), density);
    solver->planes.all = planes;
    solver->options.pic_fraction = 0;
    const double bulk = 1e8;
    if (with_water) {
      solver->fluid->options.bulk_modulus = bulk;
      solver->options.cfl = 0.04;
    }
    set_velocity<2>(*solver, [](const Vec<2>& x) { return Vec<2>(1e-4 * std::sin(2 * pi * (x[0] - 0.13)), 0); });
    if (with_water) {
      for (std::size_t k = 0; k < solver->points.size(); ++k) {
        solver->fluid->points[k].velocity = solver->points[k].velocity;
        solver->fluid->points[k].affine = solver->points[k].affine;
      }
    }
    double before = 0, then = 0, first = NAN, half = NAN;
    for (int step = 0; std::isnan(half); ++step) {
      double sum = 0;
      for (const auto& point : solver->points) sum += point.velocity[0] * std::sin(2 * pi * (point.first[0] - 0.13));
      if (step > 0 && before * sum < 0) {
        const double zero = then + (solver->time - then) * before / (before - sum);
        (std::isnan(first) ? first : half) = std::isnan(first) ? zero : zero - first;
      }
      before = sum;
      then = solver->time;
      solver->step(solver->stable_step());
    }
    const double heavy = density + sand_porosity * water_density;
    const double speed =
        with_water ? std::sqrt((sand_modulus + bulk / sand_porosity) / heavy) : std::sqrt(sand_modulus / density);
    CHECK(0.5 / half == Approx(speed).epsilon(0.05));
    CHECK(momentum_of<2>(*solver).norm() < 1e-9);
  }
}
