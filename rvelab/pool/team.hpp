// The threads of a pool: its own, or the task system of the host.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

#include "rvelab/threads/workers.hpp"

namespace rvelab::pool {

using Task = void (*)(void* work, std::int64_t index);
using RunTasks = void (*)(void* host, Task task, void* work, std::int64_t count);

class Team {
 public:
  /// `threads` in all, 0: as many as the processor runs at once; `run_tasks`, if not null, is used instead of them.
  Team(unsigned threads, RunTasks run_tasks, void* host);

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
  RunTasks run_tasks_;
  void* host_;
  std::mutex mutex_;  ///< of the workers, which serve one call at a time
  std::unique_ptr<Workers> workers_;
};

}  // namespace rvelab::pool
