// Threads that share out pieces of work.
#include "tools/mpm/workers.hpp"

#include <atomic>
#include <stdexcept>
#include <vector>

#include "tests/catch.hpp"

using mpm::Workers;

TEST_CASE("each piece is made once, whatever the number of threads and of pieces", "[workers]") {
  for (const int threads : {1, 2, 3, 8}) {
    Workers workers(threads);
    for (const long pieces : {0, 1, 2, 7, 8, 1000}) {
      for (const bool in_turn : {false, true}) {
        std::vector<std::atomic<int>> made(std::size_t(pieces) + 1);
        const auto make = [&](std::int64_t k) { ++made[std::size_t(k)]; };
        if (in_turn)
          workers.for_each_in_turn(pieces, make);
        else
          workers.for_each(pieces, make);
        bool once = true;
        for (long k = 0; k < pieces; ++k) once = once && made[std::size_t(k)] == 1;
        CAPTURE(threads, pieces, in_turn);
        CHECK(once);
      }
    }
  }
}

TEST_CASE("a failure of one piece is thrown again, and the threads work on", "[workers]") {
  Workers workers(3);
  CHECK_THROWS_AS(workers.for_each(100,
                                   [](std::int64_t k) {
                                     if (k == 42) throw std::runtime_error("piece 42");
                                   }),
                  std::runtime_error);
  std::atomic<long> sum{0};
  workers.for_each(100, [&](std::int64_t k) { sum += k; });
  CHECK(sum == 4950);
}

TEST_CASE("pieces in turn begin in the order of their numbers", "[workers]") {
  Workers workers(2);
  std::atomic<long> begun{0}, late{0};
  workers.for_each_in_turn(200, [&](std::int64_t k) {
    if (begun++ + 1 < k) ++late;  // one thread may take a number and begin after the other
  });
  CHECK(late == 0);
}
