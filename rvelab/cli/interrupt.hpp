// Ctrl-C and SIGTERM: the first asks the work to stop and put its results away, the second ends the program at once.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace rvelab::cli {

/// Takes both signals from here on. True once one has come.
const std::atomic<bool>& stop_on_signals();

/// Ends a command that keeps nothing of unfinished work: where a second after the signal it is still at it, in a phase
/// that does not ask for the signal. `done`: as for end_stopped; it may wait, for a file that is being written.
class EndInASecond {
 public:
  explicit EndInASecond(std::function<std::string()> done);
  ~EndInASecond();
  EndInASecond(const EndInASecond&) = delete;
  EndInASecond& operator=(const EndInASecond&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool over_ = false;
  std::thread thread_;
};

/// Prints "stopped by Ctrl-C" (or SIGTERM) and what was done until then, and ends the command with the code of the
/// signal.
[[noreturn]] void end_stopped(const std::string& done);

}  // namespace rvelab::cli
