// A resting Rve has let go of what it can make again; nothing that it answers or does afterwards changes by a bit.
#include <thread>
#include <utility>

#include "rvelab/error.hpp"
#include "tests/solver/laws.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Configurations that differ in what has to be made again: parameters, histories, dashpot forces, radii, images.
std::vector<Specimen> resting_configurations() {
  std::vector<Specimen> all;
  Material rolling = linear_material(2e6, 1e6, 0.4);
  rolling.rolling_stiffness = 1;
  rolling.rolling_friction = 0.2;
  all.push_back(disordered(Shape::disc, 9, rolling, Law::linear_stiffness, 0.52, 3));
  all.back().contact.rolling = true;
  all.push_back(disordered(Shape::ellipse, 9, rolling, Law::linear_stiffness, 0.52, 6));
  all.push_back(disordered(Shape::sphere, 5, hertz_material(), Law::hertz_mindlin, 0.51, 4));
  all.back().damping.dashpot = Dashpot::viscoelastic;
  all.back().damping.normal_coefficient = 1e3;
  all.push_back(
      disordered(Shape::sphere, 2, rolling, Law::linear_stiffness, 0.52, 5));  // grains touch their own images
  return all;
}

Matrix3 step(int dimension) {
  Matrix3 g = gradient(-2e-4, 3e-4, 0, -1e-4);
  if (dimension == 3) g(1, 2) = 2e-4;
  return g;
}

}  // namespace

TEST_CASE("Resting between calls changes no bit of what an Rve does", "[solver]") {
  for (const Specimen& start : resting_configurations())
    for (const double dt : {0.0, 1e-4}) {
      Rve resting(start), restless(start);
      for (int k = 0; k < 5; ++k) {
        const Response a = resting.apply(step(start.cell.dimension), dt);
        const Response b = restless.apply(step(start.cell.dimension), dt);
        CHECK(same_bits(a.stress, b.stress));
        resting.release();
        CHECK(resting.save() == restless.save());
        if (k == 2) resting.release();  // twice is once
        if (k % 2 == 0) CHECK(same_bits(resting.stress(), restless.stress()));
      }
    }
}

TEST_CASE("A resting Rve answers every question as one at work", "[solver]") {
  for (const Specimen& start : resting_configurations()) {
    Rve rve(start);
    rve.apply(step(start.cell.dimension), 1e-4);
    const auto rested = [&] {
      Rve copy = rve;
      copy.release();
      return copy;
    };
    CHECK(same_bits(rested().contact_stress(), rve.contact_stress()));
    CHECK(same_bits(rested().reynolds_stress(), rve.reynolds_stress()));
    CHECK(rested().unbalanced_ratio() == rve.unbalanced_ratio());
    CHECK(rested().critical_time_step() == rve.critical_time_step());
    const Network a = rested().network(), b = rve.network();
    REQUIRE(a.contacts.size() == b.contacts.size());
    for (std::size_t k = 0; k < a.contacts.size(); ++k) {
      CHECK(a.contacts[k].force() == b.contacts[k].force());
      CHECK(a.contacts[k].friction == b.contacts[k].friction);
    }
    const auto after = [&](Rve cell, auto change) {
      change(cell);
      cell.apply(step(start.cell.dimension), 0);
      return cell.save();
    };
    const auto smoother = [&](Rve& cell) {
      auto materials = start.materials;
      for (Material& m : materials) m.friction = 0.1;
      cell.set_materials(materials);
    };
    CHECK(after(rested(), smoother) == after(rve, smoother));
    const auto stopped = [](Rve& cell) { cell.zero_velocities(); };
    CHECK(after(rested(), stopped) == after(rve, stopped));
    const auto relaxed = [](Rve& cell) { cell.relax(1e-3, 2000); };
    CHECK(after(rested(), relaxed) == after(rve, relaxed));
    Rve copy_of_resting(start);
    copy_of_resting = rested();
    CHECK(after(copy_of_resting, relaxed) == after(rve, relaxed));
  }
}

TEST_CASE("A const call leaves a resting Rve at rest, on several threads too", "[solver]") {
  for (const Specimen& start : resting_configurations()) {
    Rve rve(start);
    rve.apply(step(start.cell.dimension), 0);
    const Matrix3 stress = rve.stress();
    const double unbalanced = rve.unbalanced_ratio(), critical = rve.critical_time_step();
    const std::size_t contacts = rve.network().contacts.size();
    rve.release();
    const auto bytes = rve.save();
    std::vector<Matrix3> found(4, Matrix3::Zero());
    std::vector<std::thread> askers;
    for (Matrix3& answer : found)
      askers.emplace_back([&answer, &asked = std::as_const(rve)] { answer = asked.stress(); });
    for (std::thread& asker : askers) asker.join();
    for (const Matrix3& answer : found) CHECK(same_bits(answer, stress));
    CHECK(rve.unbalanced_ratio() == unbalanced);
    CHECK(rve.critical_time_step() == critical);
    CHECK(rve.network().contacts.size() == contacts);
    CHECK(rve.memory().working == 0);
    CHECK(rve.save() == bytes);
  }
}

TEST_CASE("A failed call leaves a resting Rve as it was", "[solver]") {
  Rve rve(resting_configurations().front());
  rve.apply(step(2), 0);
  const auto before = rve.save();
  rve.release();
  CHECK_THROWS_AS(rve.apply(gradient(-2, 0, 0, 0), 0), InvalidIncrement);
  CHECK(rve.save() == before);
}

TEST_CASE("A resting disc cell holds state and list alone", "[solver]") {
  Rve rve(disordered(Shape::disc, 20, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.52, 3));
  rve.apply(step(2), 0);
  const double grains = double(rve.size());
  const Memory working = rve.memory();
  CHECK(working.working > working.state + working.list);
  rve.release();
  const Memory resting = rve.memory();
  CHECK(resting.working == 0);
  CHECK(resting.state == working.state);
  CHECK(resting.list == working.list);
  // A row of 64 bytes and 8 bytes of history for each of some 2 to 3 listed pairs, and a padding row or two.
  CHECK(double(resting.state) / grains < 100);
  rve.apply(step(2), 0);
  CHECK(rve.memory().working > 0);
}
