// A team of threads does each piece of work once, whatever the number of threads and whatever fails. (That RVEs answer
// with the same bits on any number of threads, and that a failure concerns its own RVE, is held at the pool:
// tests/abi.)
#include "rvelab/threads/workers.hpp"

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/catch.hpp"

using namespace rvelab;

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
