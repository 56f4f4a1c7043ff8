// Who asks where the time goes is told, and changes nothing.
#include "rvelab/solver/loading/step_times.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

TEST_CASE("The parts of the time make up no more than the calls, and measuring changes no bit", "[solver]") {
  const Matrix3 increment = gradient(4.5e-4, 0, 0, -9e-4);
  Rve plain(reference_specimen("dense")), timed(plain);
  StepTimes times;
  timed.measure_time(&times);
  for (int k = 0; k < 20; ++k) {
    plain.apply(increment, 0);
    timed.apply(increment, 0);
  }
  CHECK(plain.save() == timed.save());
  CHECK(times.grains > 0);
  CHECK(times.pairs > 0);
  CHECK(times.list > 0);  // 2 % of strain: several lists
  const double parts = times.grains + times.pairs + times.list;
  CHECK(parts <= times.calls);
  CHECK(parts >= 0.5 * times.calls);  // in increments of hundreds of sub-steps control is the lesser part

  const double calls = times.calls;
  timed.measure_time(nullptr);
  timed.apply(increment, 0);
  CHECK(times.calls == calls);
}

TEST_CASE("Copies add their time to the same sums, and so does a state that was restored", "[solver]") {
  Rve rve(reference_specimen("dense"));
  StepTimes times;
  rve.measure_time(&times);
  Rve copy(rve);
  copy.apply(gradient(1e-5, 0, 0, -2e-5), 0);
  const double of_copy = times.calls;
  CHECK(of_copy > 0);
  rve.relax(1e-9, 50);
  CHECK(times.calls > of_copy);
  const double before = times.calls;
  rve.restore(copy.save());
  rve.relax(1e-9, 50);
  CHECK(times.calls > before);
}
