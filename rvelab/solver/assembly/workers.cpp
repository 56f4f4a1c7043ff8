#include "rvelab/solver/assembly/workers.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace rvelab {

struct Workers::Team {
  std::mutex mutex;
  std::condition_variable begin, end;
  std::vector<std::thread> threads;  ///< without the caller
  bool leaving = false;
  std::uint64_t round = 0;  ///< rounds begun
  std::size_t busy = 0;     ///< threads that have not finished the present round

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
    std::unique_lock lock(mutex);
    while (true) {
      begin.wait(lock, [&] { return leaving || round != done; });
      if (leaving) return;
      done = round;
      lock.unlock();
      take_pieces();
      lock.lock();
      if (--busy == 0) end.notify_one();
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
  std::unique_lock lock(team.mutex);
  team.end.wait(lock, [&] { return team.busy == 0; });
  if (team.failure) std::rethrow_exception(std::exchange(team.failure, nullptr));
}

}  // namespace rvelab
