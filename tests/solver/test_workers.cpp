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

using Clock = std::chrono::steady_clock;
using std::chrono::microseconds;
using std::chrono::milliseconds;

/// Whether it comes true within so long.
template <class Condition>
bool comes_true(const Condition& condition, microseconds patience = milliseconds(10'000)) {
  const auto end = Clock::now() + patience;
  while (!condition() && Clock::now() < end) std::this_thread::yield();
  return condition();
}

/// Whether another thread comes to a call of ten pieces, in each of which the caller waits for it; its first piece
/// takes it that long.
bool another_comes(Workers& workers, microseconds patience, milliseconds away) {
  const auto caller = std::this_thread::get_id();
  std::atomic<bool> came{false};
  workers.for_each(10, [&](std::size_t) {
    if (std::this_thread::get_id() == caller)
      comes_true([&] { return came.load(); }, patience);
    else if (!came.exchange(true))
      std::this_thread::sleep_for(away);
  });
  return came;
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

TEST_CASE("a team whose meetings cost more than the work goes on alone for a while", "[solver]") {
  // A thread that is off its core for 20 ms costs the caller as much, who works alone for 20 times as long after it: in
  // short calls, for a long one is shared all the same.
  Workers workers(2);
  int alone = 0;
  // Again where other work on the machine left no short call in that time.
  for (int attempt = 0; alone == 0 && attempt < 10; ++attempt) {
    workers.sharing = Sharing::always;
    auto begin = Clock::now();
    do {
      begin = Clock::now();
      REQUIRE(another_comes(workers, milliseconds(1000), milliseconds(20)));
    } while (Clock::now() - begin > milliseconds(60));  // it came so late that the meeting cost little beside that
    workers.sharing = Sharing::measured;
    const auto end = Clock::now() + milliseconds(200);
    while (Clock::now() < end) {
      begin = Clock::now();
      const bool came = another_comes(workers, microseconds(100), milliseconds(0));
      if (Clock::now() - begin > microseconds(1900)) continue;
      CHECK(!came);
      ++alone;
    }
  }
  CHECK(alone > 0);
}

TEST_CASE("a team that gains by its meetings goes on together, unless it is told never to", "[solver]") {
  Workers workers(2);
  int together = 0;
  for (int call = 0; call < 100; ++call) together += another_comes(workers, milliseconds(3), milliseconds(0));
  CHECK(together > 90);
  workers.sharing = Sharing::never;
  for (int call = 0; call < 3; ++call) CHECK(!another_comes(workers, milliseconds(1), milliseconds(0)));
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
  // Of a hundred pieces half are its own: it stays in the first of them until all others are made.
  Workers workers(2);
  std::atomic<int> by_caller{0}, by_other{0};
  const auto caller = std::this_thread::get_id();
  workers.for_each(100, [&](std::size_t) {
    if (std::this_thread::get_id() == caller)
      ++by_caller;
    else if (++by_other == 1)
      CHECK(comes_true([&] { return by_caller == 99; }));
  });
  CHECK(by_caller + by_other == 100);
}

TEST_CASE("pieces in turn begin in the order of their numbers", "[solver]") {
  Workers workers(2);
  std::atomic<long> second{-1};
  workers.for_each_in_turn(200, [&](std::size_t k) {
    long none = -1;
    if (k > 0)
      second.compare_exchange_strong(none, long(k));
    else
      comes_true([&] { return second >= 0; });
  });
  CHECK(second == 1);  // in parts of their own it would be 100
}
