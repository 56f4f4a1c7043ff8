// What collisions ask of the time step, whether row sums were left out or not.
#include <random>

#include "rvelab/solver/loading/collisions.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/oracle/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// A specimen of several laws and shapes, compressed at a rate and with velocities of its own.
Specimen moving(Specimen start, double speed) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  const int d = start.cell.dimension;
  start.state.quasi_static = false;
  for (Vector3& velocity : start.grains.velocity)
    velocity = speed * Vector3(normal(generator), normal(generator), d == 3 ? normal(generator) : 0);
  return start;
}

}  // namespace

TEST_CASE("Row sums that collisions leave out would have asked for no shorter step", "[solver]") {
  Material hertz;
  hertz.young_modulus = 1e9;
  hertz.poisson_ratio = 0.3;
  hertz.friction = 0.5;
  const std::vector<Specimen> specimens = {
      disordered(Shape::disc, 9, linear_material(2e6, 1e6, 0.4), Law::linear_given, 0.52, 3),
      disordered(Shape::disc, 9, hertz, Law::hertz_mindlin, 0.51, 6),
      disordered(Shape::ellipse, 9, linear_material(2e6, 1e6, 0.4), Law::linear_given, 0.52, 3),
      disordered(Shape::sphere, 5, hertz, Law::hertz_mindlin, 0.51, 4),
      disordered(Shape::sphere, 5, linear_material(2e6, 5e5, 0.4), Law::linear_given, 0.52, 8)};
  for (const Specimen& start : specimens) {
    for (const double speed : {1e-6, 1e-3, 0.1}) {
      CAPTURE(int(start.shape), int(start.contact.law), speed);
      Model model;
      Assembly assembly;
      open_assembly(moving(start, speed), model, assembly);
      const double horizon = 100 * critical_step(model, row_sums(model, assembly));
      Outlook outlook{Matrix3::Zero(), horizon, std::numeric_limits<double>::infinity()};
      const double exact = collisions_ahead(model, assembly, nullptr, true, outlook).step;
      REQUIRE(exact > 0);
      REQUIRE(std::isfinite(exact));
      for (const double part : {0.01, 0.1, 0.5, 0.9, 0.999, 1.0, 1.001, 1.1, 2.0, 10.0}) {
        outlook.step = part * exact;
        const double found = collisions_ahead(model, assembly, nullptr, true, outlook).step;
        CAPTURE(part);
        CHECK(std::min(found, outlook.step) == std::min(exact, outlook.step));
        CHECK(found <= exact);
      }
    }
  }
}
