#include "rvelab/threads/workers.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace rvelab {

namespace {

/// Waits a little for what another thread is about to do: waking a thread that sleeps takes 10 to 50 us, as long as a
/// sub-step of an RVE. Whether it came; if not, the caller sleeps.
template <class Come>
bool comes_soon(const Come& come) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(50);
  do {
    for (int look = 0; look < 16; ++look) {
      if (come()) return true;
#if defined(__x86_64__)
      __builtin_ia32_pause();
#endif
    }
  } while (std::chrono::steady_clock::now() < end);
  return false;
}

}  // namespace

struct Workers::Team {
  std::mutex mutex;
  std::condition_variable begin, end;
  std::vector<std::thread> threads;  ///< without the caller
  bool leaving = false;
  bool waits_awake = false;             ///< there is a processor for each thread
  std::atomic<std::uint64_t> round{0};  ///< rounds begun
  std::atomic<std::size_t> busy{0};     ///< threads that have not finished the present round

  const std::function<void(std::size_t)>* work = nullptr;
  std::size_t count = 0;
  std::atomic<std::size_t> next{0};
  std::size_t failed_piece = 0;
  std::exception_ptr failure;

  /// Pieces are taken one by one: increments of unlike cost leave no thread idle.
  void take_pieces() {
    for (std::size_t piece = next++; piece < count; piece = next++) {
      try {
        (*work)(piece);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (failure && failed_piece < piece) continue;
        failure = std::current_exception();
        failed_piece = piece;
      }
    }
  }

  void serve() {
    std::uint64_t done = 0;
    while (true) {
      if (!waits_awake || !comes_soon([&] { return round != done; })) {
        std::unique_lock lock(mutex);
        begin.wait(lock, [&] { return leaving || round != done; });
        if (leaving) return;
      }
      done = round;
      take_pieces();
      if (--busy == 0) {
        const std::lock_guard lock(mutex);  // the caller is asleep, or has not looked yet
        end.notify_one();
      }
    }
  }

  void leave() {
    {
      const std::lock_guard lock(mutex);
      leaving = true;
    }
    begin.notify_all();
    for (std::thread& thread : threads) thread.join();
  }
};

Workers::Workers(unsigned threads) : team_(std::make_unique<Team>()) {
  team_->waits_awake = threads <= std::thread::hardware_concurrency();
  try {
    for (unsigned k = 1; k < threads; ++k) team_->threads.emplace_back([team = team_.get()] { team->serve(); });
  } catch (...) {  // no memory or no thread to be had: those that are there would end the program
    team_->leave();
    throw;
  }
}

Workers::~Workers() { team_->leave(); }

unsigned Workers::threads() const { return unsigned(team_->threads.size()) + 1; }

void Workers::run(std::size_t count, const std::function<void(std::size_t)>& work) {
  Team& team = *team_;
  {
    const std::lock_guard lock(team.mutex);
    team.work = &work;
    team.count = count;
    team.next = 0;
    team.failure = nullptr;
    team.busy = team.threads.size();
    ++team.round;
  }
  team.begin.notify_all();
  team.take_pieces();
  if (!team.waits_awake || !comes_soon([&] { return team.busy == 0; })) {
    std::unique_lock lock(team.mutex);
    team.end.wait(lock, [&] { return team.busy == 0; });
  }
  if (team.failure) std::rethrow_exception(std::exchange(team.failure, nullptr));
}

}  // namespace rvelab
