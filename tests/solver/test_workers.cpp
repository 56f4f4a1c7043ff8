// Threads that share out pieces of work. (That RVEs answer with the same bits on any number of threads, and that a
// failure concerns its own RVE, is held at the pool: tests/abi.)
#include "rvelab/threads/workers.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/catch.hpp"

using namespace rvelab;

namespace {

using Sharing = Workers::Sharing;
constexpr Sharing each_sharing[] = {Sharing::measured, Sharing::always, Sharing::never};

/// Of so many calls of ten pieces, those in which other threads than the caller's made some.
template <class Piece>
long shared_calls(Workers& workers, long calls, const Piece& piece) {
  const auto caller = std::this_thread::get_id();
  long shared = 0;
  for (long call = 0; call < calls; ++call) {
    std::atomic<bool> other{false};
    workers.for_each(10, [&](std::size_t) {
      const bool away = std::this_thread::get_id() != caller;
      if (away) other = true;
      piece(away);
    });
    shared += other;
  }
  return shared;
}

}  // namespace

TEST_CASE("each piece is made once, whatever the number of threads and of pieces, and however they share", "[solver]") {
  for (const unsigned threads : {0u, 1u, 2u, 3u, 8u}) {
    Workers workers(threads);
    for (const Sharing sharing : each_sharing) {
      workers.sharing = sharing;
      for (const long pieces : {0, 1, 2, 7, 8, 1000}) {
        for (const bool in_turn : {false, true}) {
          std::vector<std::atomic<int>> made(std::size_t(pieces) + 1);
          const auto make = [&](std::size_t k) { ++made[std::size_t(k)]; };
          if (in_turn)
            workers.for_each_in_turn(pieces, make);
          else
            workers.for_each(pieces, make);
          bool once = true;
          for (long k = 0; k < pieces; ++k) once = once && made[std::size_t(k)] == 1;
          once = once && made[std::size_t(pieces)] == 0;
          CAPTURE(threads, pieces, in_turn, int(sharing));
          CHECK(once);
        }
      }
    }
  }
}

TEST_CASE("pieces that come after others find what these left, on any number of threads", "[solver]") {
  // Each piece changes three of 40 places, and comes after the last that changed one of them.
  constexpr std::size_t pieces = 3000, places = 40;
  const auto places_of = [](std::size_t k) {
    return std::array<std::size_t, 3>{k * 7 % places, k * k % places, (k * 13 + k / 40) % places};
  };
  std::vector<WorkOrder::Pair> pairs;
  std::array<long, places> last;
  last.fill(-1);
  for (std::size_t k = 0; k < pieces; ++k) {
    for (const std::size_t place : places_of(k)) {
      const long before = std::exchange(last[place], long(k));
      if (before >= 0 && before != long(k)) pairs.push_back({std::size_t(before), k});
    }
  }
  const WorkOrder order(pieces, pairs);
  REQUIRE(order.pieces() == pieces);
  std::vector<std::array<double, places>> ends;
  for (const unsigned threads : {1u, 2u, 3u, 5u}) {
    Workers workers(threads);
    for (const Sharing sharing : each_sharing) {
      workers.sharing = sharing;
      std::array<double, places> values;
      values.fill(1);
      for (int call = 0; call < 5; ++call) {
        workers.for_each_after(order, [&](std::size_t k) {
          double sum = 0.1 * double(k % 11);
          for (const std::size_t place : places_of(std::size_t(k))) sum = 0.7 * sum + values[place];
          for (const std::size_t place : places_of(std::size_t(k))) values[place] = std::sin(sum + double(place));
        });
      }
      ends.push_back(values);
    }
  }
  for (const auto& end : ends) CHECK(end == ends[0]);
}

TEST_CASE("a failure of a piece that others come after is thrown again, and nobody waits for it", "[solver]") {
  std::vector<WorkOrder::Pair> pairs;
  for (std::size_t k = 1; k < 100; ++k) pairs.push_back({k - 1, k});
  const WorkOrder chain(100, pairs);
  for (const Sharing sharing : each_sharing) {
    Workers workers(3);
    workers.sharing = sharing;
    std::atomic<long> last{-1};
    CHECK_THROWS_AS(workers.for_each_after(chain,
                                           [&](std::size_t k) {
                                             last = long(k);
                                             if (k == 42) throw std::runtime_error("piece 42");
                                           }),
                    std::runtime_error);
    CHECK(last == 42);
    workers.for_each_after(chain, [&](std::size_t k) { last = long(k); });
    CHECK(last == 99);
  }
}

TEST_CASE("a team whose meetings cost more than the work goes on alone", "[solver]") {
  // A millisecond or two alone; a thread that comes is off its core for 10 ms in the middle of a piece. Asleep, so that
  // it does not matter what else the machine does.
  const auto piece = [](bool away) { std::this_thread::sleep_for(std::chrono::microseconds(away ? 10'000 : 100)); };
  Workers workers(2);
  workers.sharing = Sharing::always;
  const long always = shared_calls(workers, 30, piece);
  CHECK(always > 10);
  workers.sharing = Sharing::measured;
  CHECK(shared_calls(workers, 300, piece) < 10 * always / 4);
  workers.sharing = Sharing::never;
  CHECK(shared_calls(workers, 100, piece) == 0);
}

TEST_CASE("a team that gains by its meetings goes on together", "[solver]") {
  const auto piece = [](bool) { std::this_thread::sleep_for(std::chrono::microseconds(500)); };
  Workers workers(2);
  CHECK(shared_calls(workers, 100, piece) > 90);
}

TEST_CASE("the failure of the lowest piece is thrown when all are done, and the threads work on", "[solver]") {
  for (const unsigned threads : {0u, 1u, 4u}) {
    Workers workers(threads);
    for (const Sharing sharing : each_sharing) {
      workers.sharing = sharing;
      for (const bool in_turn : {false, true}) {
        std::atomic<int> made{0};
        const auto faulty = [&](std::size_t k) {
          ++made;
          if (k == 5 || k == 20) throw std::runtime_error(std::to_string(k));
        };
        if (in_turn)
          CHECK_THROWS_WITH(workers.for_each_in_turn(30, faulty), "5");
        else
          CHECK_THROWS_WITH(workers.for_each(30, faulty), "5");
        CHECK(made == 30);
        workers.for_each(3, [&](std::size_t) { ++made; });
        CHECK(made == 33);
      }
    }
  }
}

TEST_CASE("a thread that is far behind is helped", "[solver]") {
  Workers workers(2);
  std::vector<std::thread::id> by(100);
  const auto caller = std::this_thread::get_id();
  workers.for_each(100, [&](std::size_t k) {
    by[std::size_t(k)] = std::this_thread::get_id();
    if (by[std::size_t(k)] != caller) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  });
  CHECK(std::count(by.begin(), by.end(), caller) > 90);
}

TEST_CASE("pieces in turn begin in the order of their numbers", "[solver]") {
  Workers workers(2);
  std::atomic<long> second{-1};
  workers.for_each_in_turn(200, [&](std::size_t k) {
    if (k > 0) {
      long none = -1;
      second.compare_exchange_strong(none, long(k));
      return;
    }
    for (int wait = 0; wait < 10000 && second < 0; ++wait) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  CHECK(second == 1);  // in parts of their own it would be 100
}
