// Batches: what one RVE does does not depend on the others, on the number of workers, or on failures beside it.
#include <atomic>
#include <stdexcept>

#include "rvelab/error.hpp"
#include "rvelab/solver/batch.hpp"
#include "tests/oracle/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

std::vector<Rve> cells(int count) {
  std::vector<Rve> rves;
  for (int k = 0; k < count; ++k) {
    const Shape shape = k % 3 == 0 ? Shape::sphere : Shape::disc;
    rves.emplace_back(disordered(shape, shape == Shape::disc ? 6 : 3, linear_material(2e6, 1e6, 0.4), Law::linear_given,
                                 0.53, k + 1));
  }
  return rves;
}

std::vector<Matrix3> increments(std::size_t count, int round) {
  std::vector<Matrix3> all;
  for (std::size_t k = 0; k < count; ++k)
    all.push_back((1 + double(k) / double(count)) * gradient(-1e-4, round % 2 == 0 ? 2e-4 : -1e-4, 0, 5e-5));
  return all;
}

}  // namespace

TEST_CASE("A batch gives the bits of single cells, whatever the number of workers", "[solver]") {
  constexpr std::size_t count = 23;
  for (const double dt : {0.0, 1e-3}) {
    std::vector<Rve> single = cells(count);
    std::vector<std::vector<Response>> expected;
    for (int round = 0; round < 3; ++round) {
      const auto steps = increments(count, round);
      auto& row = expected.emplace_back();
      for (std::size_t k = 0; k < count; ++k) row.push_back(single[k].apply(steps[k], dt));
    }
    for (const unsigned threads : {1u, 2u, 3u, 8u}) {
      std::vector<Rve> rves = cells(count);
      Workers workers(threads);
      CHECK(workers.threads() == threads);
      for (int round = 0; round < 3; ++round) {
        const auto entries = apply_to_all(rves, increments(count, round), dt, workers);
        REQUIRE(entries.size() == count);
        for (std::size_t k = 0; k < count; ++k) {
          REQUIRE(!entries[k].failure);
          CHECK(entries[k].response.stress == expected[std::size_t(round)][k].stress);
          CHECK(entries[k].response.report.substeps == expected[std::size_t(round)][k].report.substeps);
        }
      }
      for (std::size_t k = 0; k < count; ++k) CHECK(rves[k].save() == single[k].save());
    }
  }
}

TEST_CASE("A failed increment of a batch leaves its cell as it was and the others done", "[solver]") {
  std::vector<Rve> rves = cells(9), alone = cells(9);
  auto steps = increments(9, 0);
  steps[4] = gradient(std::numeric_limits<double>::quiet_NaN(), 0, 0, 0);
  steps[7] = gradient(-2, 0, 0, 0);  // turned inside out
  const auto before4 = rves[4].save(), before7 = rves[7].save();
  Workers workers(3);
  const auto entries = apply_to_all(rves, steps, 0, workers);
  for (std::size_t k = 0; k < 9; ++k) {
    const bool refused = k == 4 || k == 7;
    CHECK(bool(entries[k].failure) == refused);
    if (refused) {
      CHECK_THROWS_AS(std::rethrow_exception(entries[k].failure), InvalidIncrement);
    } else {
      CHECK(entries[k].response.stress == alone[k].apply(steps[k], 0).stress);
    }
  }
  CHECK(rves[4].save() == before4);
  CHECK(rves[7].save() == before7);
  CHECK_THROWS_AS(apply_to_all(rves, std::span(steps).first(8), 0, workers), InputError);
}

TEST_CASE("Workers do every piece once and pass on the failure of the lowest piece", "[solver]") {
  for (const unsigned threads : {0u, 1u, 4u}) {
    Workers workers(threads);
    for (int round = 0; round < 50; ++round) {
      std::vector<std::atomic<int>> done(37);
      workers.run(done.size(), [&](std::size_t k) { ++done[k]; });
      for (const auto& count : done) CHECK(count == 1);
    }
    workers.run(0, [](std::size_t) { FAIL("there is no piece"); });
    std::atomic<int> made{0};
    const auto faulty = [&](std::size_t k) {
      ++made;
      if (k == 5 || k == 20) throw std::runtime_error(std::to_string(k));
    };
    CHECK_THROWS_WITH(workers.run(30, faulty), "5");
    CHECK(made == 30);
    workers.run(3, [&](std::size_t) { ++made; });  // and goes on
    CHECK(made == 33);
  }
}
