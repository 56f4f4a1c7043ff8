// Threads that share out pieces of work.
#include "tools/mpm/workers.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
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
        once = once && made[std::size_t(pieces)] == 0;
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

TEST_CASE("a thread that is far behind is helped", "[workers]") {
  Workers workers(2);
  std::vector<std::thread::id> by(100);
  const auto caller = std::this_thread::get_id();
  workers.for_each(100, [&](std::int64_t k) {
    by[std::size_t(k)] = std::this_thread::get_id();
    if (by[std::size_t(k)] != caller) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  });
  CHECK(std::count(by.begin(), by.end(), caller) > 90);
}

TEST_CASE("pieces in turn begin in the order of their numbers", "[workers]") {
  Workers workers(2);
  std::atomic<std::int64_t> second{-1};
  workers.for_each_in_turn(200, [&](std::int64_t k) {
    if (k > 0) {
      std::int64_t none = -1;
      second.compare_exchange_strong(none, k);
      return;
    }
    for (int wait = 0; wait < 10000 && second < 0; ++wait) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  CHECK(second == 1);  // in parts of their own it would be 100
}
