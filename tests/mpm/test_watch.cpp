// What a run is told, and ended by: energy from nothing, and a time step that shrinks away.
#include <sstream>

#include "tests/catch.hpp"
#include "tests/mpm/blocks.hpp"
#include "tools/mpm/step/watch.hpp"

using namespace mpm;
using namespace mpm::test;
using Catch::Matchers::Contains;

namespace {

template <class Work>
std::string reason(const Work& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("energy that nothing accounts for is told beyond a quarter of the largest, and ends a run beyond a half") {
  auto solver = block<2>({8, 8}, 0.125, soil, 2000);
  solver->options.gravity = Vec<2>(0, -9.81);
  const auto start = energy_start<2>(*solver);
  Watched seen;
  std::ostringstream told;
  const auto look = [&] { return reason([&] { watch_energy<2>(*solver, start, seen, told); }); };
  while (solver->time < 0.2) {
    solver->step(solver->stable_step());
    CHECK(look() == "none");  // free fall, from its first step on
  }
  CHECK(told.str().empty());
  const double fallen = 0.5 * 2000 * std::pow(9.81 * solver->time, 2);
  CHECK(seen.energy == Approx(fallen).epsilon(0.05));
  // Stress that gave work and lost none of it.
  solver->points[0].work += 0.35 * fallen;
  CHECK(look() == "none");
  CHECK_THAT(told.str(), Contains(" J are not accounted for") && Contains("(the run ends at 50)"));
  const auto once = told.str();
  CHECK(look() == "none");
  CHECK(told.str() == once);
  solver->points[0].work += 0.35 * fallen;
  CHECK_THAT(look(), Contains("% of the largest energy so far (allowed: 50): the run ends; take a smaller time.cfl"));
  solver->points[0].work = std::nan("");
  CHECK_THAT(look(), Contains("the run ends"));
}

TEST_CASE("points that gain speed in mapping have it from nothing") {
  auto solver = block<2>({4, 4}, 0.25, soil, 2000);
  set_velocity<2>(*solver, [](const Vec<2>&) { return Vec<2>(1, 0); });
  const auto start = energy_start<2>(*solver);
  Watched seen;
  std::ostringstream told;
  for (int k = 0; k < 100; ++k) solver->step(solver->stable_step());
  watch_energy<2>(*solver, start, seen, told);
  for (auto& point : solver->points) point.velocity *= 2;
  CHECK_THAT(reason([&] { watch_energy<2>(*solver, start, seen, told); }), Contains("the run ends"));
}

TEST_CASE(
    "a step below a thousandth of the first is told with what asks for it, and below a millionth it ends the run") {
  auto solver = block<2>({4, 4}, 0.25, soil, 2000);
  solver->groups[0].name = "clay";
  Watched seen;
  std::ostringstream told;
  const auto look = [&] { return reason([&] { watch_step<2>(*solver, solver->stable_step(), seen, told); }); };
  CHECK(look() == "none");
  solver->points[5].velocity = Vec<2>(3e4, 0);
  CHECK(look() == "none");
  CHECK(told.str().empty());
  solver->points[5].velocity = Vec<2>(3e5, 0);
  CHECK(look() == "none");
  CHECK_THAT(told.str(), Contains("the point of material clay at [0.6875, 0.0625] m, which moves at 300000 m/s"));
  const auto once = told.str();
  CHECK(look() == "none");
  CHECK(told.str() == once);
  solver->points[5].velocity.setZero();
  solver->points[7].volume *= 1e15;
  CHECK_THAT(look(), Contains("the run would stand still: it ends") && Contains("the wave of material clay") &&
                         Contains("at its point at [0.9375, 0.0625] m"));
}
