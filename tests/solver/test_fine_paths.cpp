// Quasi-static paths cut finely, with turns and pauses, against resolved increments from the same state.
#include "tests/solver/resolved.hpp"

using namespace rvelab;
using namespace rvelab::test;

TEST_CASE("A path cut finely costs little more than the path in increments of 1e-4", "[solver]") {
  const Specimen s = reference_specimen("dense");
  const auto run = [&](long pieces) {
    Rve rve(s);
    Response last;
    for (long k = 0; k < pieces; ++k) last = rve.apply(2e-3 / double(pieces) * biaxial_step, 0);
    return std::pair(last.stress, rve.grain_steps() / s.grains.size());
  };
  const auto [whole, steps] = run(20);
  const auto [tenth, steps_tenth] = run(200);
  const auto [hundredth, steps_hundredth] = run(2000);
  CHECK(double(steps_tenth) <= 1.2 * double(steps));
  CHECK(steps_hundredth <= std::max<std::uint64_t>(2 * steps, 2000 + 100));  // at least one for each call
  const auto [thousandth, steps_thousandth] = run(20'000);                   // these share sub-steps
  CHECK(steps_thousandth <= 6 * steps);
  const double allowed = 1e-2 * (whole - Rve(s).stress()).norm() + 1e-4 * 1e5;
  CHECK((tenth - whole).norm() <= allowed);
  CHECK((hundredth - whole).norm() <= allowed);
  CHECK((thousandth - whole).norm() <= allowed);
}

TEST_CASE("A path cut finely is not told to miss its tolerance piece by piece", "[solver]") {
  for (const long pieces : {20L, 200L, 2000L, 20'000L}) {
    CAPTURE(pieces);
    Rve rve(reference_specimen("dense"));
    long missed = 0;
    for (long k = 0; k < pieces; ++k)
      missed += rve.apply(2e-3 / double(pieces) * biaxial_step, 0).report.tolerance_met ? 0 : 1;
    CHECK(double(missed) <= 0.2 * double(pieces));  // one interval where contacts slip is 26 of 200
  }
}

TEST_CASE("A path that turns back, aside, or waits keeps to the resolved one, finely cut", "[solver]") {
  const Specimen s = reference_specimen("dense");
  const auto run = [&](long pieces, long substeps) {
    Specimen t = s;
    t.solver.fixed_substeps = substeps;
    Rve rve(t);
    std::vector<Matrix3> corners;
    for (const Matrix3& leg :
         {biaxial_step, Matrix3(-biaxial_step), shear_step, Matrix3(Matrix3::Zero()), biaxial_step}) {
      for (long k = 0; k < pieces; ++k) rve.apply(3e-4 / double(pieces) * leg, 0);
      corners.push_back(rve.stress());
    }
    return corners;
  };
  const std::vector<Matrix3> truth = run(3, 2000);
  for (const long pieces : {3L, 30L, 300L, 3000L}) {
    const std::vector<Matrix3> found = run(pieces, 0);
    for (std::size_t k = 0; k < truth.size(); ++k) {
      CAPTURE(pieces, k);
      const Matrix3 from = k == 0 ? Rve(s).stress() : truth[k - 1];
      // The error of each straight part is carried on: one allowance for each part so far.
      CHECK((found[k] - truth[k]).norm() <= double(k + 1) * (1e-2 * (truth[k] - from).norm() + 1e-4 * 1e5));
    }
  }
}

TEST_CASE("Tiny increments are no identity: they add up, save and restore bitwise", "[solver]") {
  const Specimen s = reference_specimen("dense");
  Rve straight(s), restored(s);
  for (int k = 0; k < 300; ++k) {
    const Matrix3 increment = (k / 100 == 1 ? -1e-7 : 1e-7) * biaxial_step;
    const Response a = straight.apply(increment, 0), b = restored.apply(increment, 0);
    CHECK(same_bits(a.stress, b.stress));
    CHECK(a.report.error_estimate == b.report.error_estimate);
    if (k % 37 == 0) {
      const std::vector<std::byte> bytes = restored.save();
      restored = Rve(s);
      restored.restore(bytes);
    }
  }
  CHECK(straight.save() == restored.save());
}

TEST_CASE("A specimen that was never loaded is an equilibrium, and so is a pause", "[solver]") {
  Rve rve(reference_specimen("dense"));
  const Response first = rve.apply(Matrix3::Zero(), 0);
  CHECK(first.report.in_equilibrium);
  CHECK(first.report.allowed_error == Approx(1e-4 * 1e5).epsilon(0.01));
  CHECK(first.report.error_estimate < first.report.allowed_error);
  rve.apply(1e-4 * biaxial_step, 0);
  const Matrix3 stress = rve.stress();
  const Response pause = rve.apply(Matrix3::Zero(), 0);
  CHECK(same_bits(pause.stress, stress));
  CHECK(pause.report.error_estimate > 0);
}
