#include "rvelab/pool/team.hpp"

#include <signal.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "rvelab/pool/floating_point.hpp"
#include "rvelab/threads/classic_locale.hpp"

namespace rvelab::pool {

namespace {

/// Threads that take no signal: those are the host's.
std::unique_ptr<Workers> started(unsigned threads) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::unique_ptr<Workers> workers;
  try {
    workers = std::make_unique<Workers>(threads);
  } catch (const NotStarted&) {  // no thread is to be had: the calling one does the work, with the same bits
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return workers;
}

/// A round of pieces on the threads of the host, each marked when it is begun.
struct Round {
  const std::function<void(std::size_t)>& piece;
  std::vector<std::atomic<bool>> begun;
  std::atomic<std::size_t> done{0};
  std::atomic<bool> repeated{false};

  static void work(void* round, std::int64_t index) noexcept {
    const FloatingPoint environment;
    const ClassicLocale locale;
    Round& self = *static_cast<Round*>(round);
    if (index < 0 || std::size_t(index) >= self.begun.size() || self.begun[std::size_t(index)].exchange(true)) {
      self.repeated = true;
      return;
    }
    self.piece(std::size_t(index));
    ++self.done;
  }
};

}  // namespace

Team::Team(const Options& options)
    : threads_(options.workers > 0 ? unsigned(options.workers) : std::max(1u, std::thread::hardware_concurrency())),
      run_tasks_(options.run_tasks),
      host_(options.host) {}

void Team::run_by_host(std::size_t count, const std::function<void(std::size_t)>& piece) {
  Round round{piece, std::vector<std::atomic<bool>>(count)};
  run_tasks_(host_, Round::work, &round, std::int64_t(count));
  // What the host left undone is done here, so that no entry is without an answer; the host gets the status all the
  // same.
  const std::size_t done = round.done;
  for (std::size_t k = 0; k < count; ++k)
    if (!round.begun[k].exchange(true)) piece(k);
  if (done != count || round.repeated)
    throw Refused(Status::bad_input, "run_tasks: " + std::to_string(done) + " of " + std::to_string(count) +
                                         " tasks were done when it returned" +
                                         (round.repeated ? ", and one was begun twice or is no task" : "") +
                                         "; it must run each once and return when all are done");
}

void Team::run(std::size_t count, const std::function<void(std::size_t)>& piece) {
  if (run_tasks_ != nullptr) return run_by_host(count, piece);
  std::unique_lock lock(mutex_, std::defer_lock);
  if (count > 1 && threads_ > 1 && lock.try_lock()) {
    if (!workers_) workers_ = started(threads_);
    if (workers_) return workers_->for_each_in_turn(count, piece);
  }
  for (std::size_t k = 0; k < count; ++k) piece(k);
}

void Team::share(std::size_t count, const std::function<void(std::size_t)>& piece) {
  constexpr std::size_t block = 32, least = 256;  // waking the threads takes some 10 us
  if (count >= least) {
    std::unique_lock lock(mutex_, std::try_to_lock);
    if (lock && workers_)
      return workers_->for_each((count + block - 1) / block, [&piece, count](std::size_t part) {
        for (std::size_t k = part * block; k < std::min(count, (part + 1) * block); ++k) piece(k);
      });
  }
  for (std::size_t k = 0; k < count; ++k) piece(k);
}

bool Team::share_all(std::size_t count, const std::function<void(std::size_t)>& piece) {
  std::atomic<bool> failed{false};
  share(count, [&piece, &failed](std::size_t k) {
    try {
      piece(k);
    } catch (...) {
      failed = true;
    }
  });
  return !failed;
}

}  // namespace rvelab::pool
