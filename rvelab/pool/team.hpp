// The threads of a pool: its own, or the task system of the host.
#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include "rvelab/pool/pool.hpp"

namespace rvelab::pool {

class Team {
 public:
  /// Of the workers, or the task system of the host, that the options name.
  explicit Team(const Options& options);

  /// Calls piece(k) for k = 0 .. count - 1, each once, small k first. Threads are started when they are first needed;
  /// where none can be, or another call has them, the calling thread does all. `piece` must not throw. Throws Refused
  /// (bad_input) if the host left a piece undone or began one twice.
  void run(std::size_t count, const std::function<void(std::size_t)>& piece);

  /// The same for pieces of a tenth of a microsecond: many are one piece of work, and few are done by the calling
  /// thread, as all are before `run` has started threads, or where the host has them. Allocates nothing.
  void share(std::size_t count, const std::function<void(std::size_t)>& piece);
  /// Whether none of them has thrown; each was begun.
  bool share_all(std::size_t count, const std::function<void(std::size_t)>& piece);

 private:
  void run_by_host(std::size_t count, const std::function<void(std::size_t)>& piece);

  unsigned threads_;
  rvelab_run_tasks run_tasks_;
  void* host_;
  std::mutex mutex_;  ///< of the workers, which serve one call at a time
  std::unique_ptr<Workers> workers_;
};

}  // namespace rvelab::pool
