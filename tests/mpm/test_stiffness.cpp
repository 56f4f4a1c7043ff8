// The stable step of grains: the modulus of their waves as they stiffen and soften.
#include "tests/child.hpp"
#include "tests/mpm/scenes.hpp"
#include "tools/mpm/step/energy.hpp"

using namespace mpm;
using namespace mpm::test;
using rvelab::test::Child;
using rvelab::test::Folder;

namespace {

/// Discs with contacts of Hertz, whose stiffness grows with the pressure: 12 MPa at 20 kPa, 42 MPa at 500 kPa.
constexpr const char* recipe = R"(
[pack]
name = "Hertz discs"
shape = "disc"
number = 150
seed = 1
thickness_m = 0.1
[grains]
grading = "uniform"
smallest_radius_m = 3e-3
largest_radius_m = 7e-3
[target]
pressure_Pa = 20e3
void_ratio = 0.2
[contact]
law = "hertz_mindlin"
[[material]]
name = "glass"
density_kg_m3 = 2650
young_modulus_Pa = 7e9
poisson_ratio = 0.25
friction = 0.5
)";

void hertz(const Folder& folder) {
  std::ofstream(folder / "hertz.toml") << recipe;
  Child child({RVELAB_PROGRAM, "pack", folder / "hertz.toml", "-o", folder / "hertz.h5"}, folder / "out",
              folder / "err");
  REQUIRE(child.wait() == 0);
}

/// An oedometer of 2 x 2 cells with a point in each; its top comes down.
const std::string oedometer = head("oedometer", "0.5\nfollows = \"top\"", "5") +
                              "[initial]\nstress = \"isotropic\"\npressure_Pa = 20e3\n"
                              "[[material]]\nname = \"hertz\"\nkind = \"grains\"\nspecimens = [\"hertz.h5\"]\n" +
                              region("hertz", "[0, 0]", "[1, 1]", "points_per_cell = 1\n") +
                              boundary("left", "roller", "x", "0") + boundary("right", "roller", "x", "1", below) +
                              boundary("bottom", "roller", "y", "0") +
                              boundary("top", "roller", "y", "1", below + "motion = [[0, 0, 0], [0.1, 0, -0.1]]\n");

}  // namespace

TEST_CASE("the wave modulus follows grains that stiffen, and that soften again, for less than 1 % of their sub-steps") {
  const Folder folder;
  hertz(folder);
  rvelab::Workers workers(2);
  auto pool = std::make_shared<GrainPool>(workers, GrainOptions{});
  SpecimenFamily family(pool, {folder / "hertz.h5"});
  std::vector<std::int64_t> ids;
  for (int k = 0; k < 25; ++k) ids.push_back(family.spawn(20e3));
  family.release();
  std::vector<Point<2>> points(ids.size());
  Grains<2> grains(pool, ids, false, 0);
  grains.read_stress(points.data());
  const double first = grains.wave_modulus();
  CHECK(first == Approx(wave_modulus_of(*pool, ids[0])));
  const auto strain = [&](double step, double until) {
    while ((mean_pressure<2>(points[0].stress) - until) * step > 0) {
      for (auto& point : points) point.gradient = step * Mat<2>::Identity();
      grains.advance(points.data(), long(points.size()), 0, workers);
    }
  };
  strain(-1e-5, 500e3);
  const double stiff = wave_modulus_of(*pool, ids[0]);
  CHECK(stiff > 2 * first);
  CHECK(grains.wave_modulus() > 0.95 * stiff);
  CHECK(grains.wave_modulus() < 1.5 * stiff);
  strain(1e-5, 40e3);
  strain(-3e-8, 41e3);
  const double soft = wave_modulus_of(*pool, ids[0]);
  CHECK(soft < 0.6 * stiff);
  CHECK(grains.wave_modulus() > 0.95 * soft);
  CHECK(grains.wave_modulus() < 1.5 * soft);
  // A check goes through a few dozen sub-steps of one RVE.
  const double before = grains.grain_steps();
  measured_modulus_of(*pool, ids[0], 2);
  CHECK((grains.grain_steps() - before) * grains.called / 75'000 < 0.01 * before);
}

TEST_CASE("a block of Hertzian grains compressed from 20 kPa to 1 MPa stays stable with the default step") {
  const Folder folder;
  hertz(folder);
  auto model = set_up<2>(scene_of(oedometer, {}, folder), 2, folder.path());
  auto& solver = model->solver;
  const auto start = energy_start<2>(solver);
  const double first_step = solver.stable_step();
  const auto pressure = [&] {
    double sum = 0;
    for (const auto& point : solver.points) sum -= point.stress(1, 1) / double(solver.points.size());
    return sum;
  };
  while (pressure() < 1e6) {
    solver.step(solver.stable_step());
    REQUIRE(solver.time < 2);
  }
  const auto balance = energy_balance<2>(solver, start);
  CHECK(std::abs(balance.residual) < 0.01 * balance.stress_work);
  CHECK(balance.kinetic < 1e-3 * balance.stress_work);
  double wave = 0;
  for (std::size_t k = 0; k < solver.points.size(); ++k) {
    CHECK(solver.points[k].stress(1, 1) == Approx(-pressure()).epsilon(0.03));
    const auto& point = solver.points[k];
    const auto& grains = *model->grains.at("hertz");
    wave = std::max(wave, wave_modulus_of(*model->pools.at("hertz"), grains.ids()[k]) * point.volume / point.mass);
  }
  const double step = solver.stable_step();
  CHECK(step < 0.7 * first_step);
  CHECK(step * std::sqrt(wave) < 1.05 * solver.options.cfl * solver.grid.cell.minCoeff());
  CHECK(step * std::sqrt(wave) > 0.8 * solver.options.cfl * solver.grid.cell.minCoeff());
}
