// Ctrl-C and SIGTERM: the first requests the work to stop and save its results, the second ends the program at once.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace rvelab::cli {

/// Handles both signals from this call on. Becomes true after the first signal.
const std::atomic<bool>& stop_on_signals();

/// Ends a command that keeps no unfinished work, if it still runs a second after the signal in a phase that does not
/// check for it. `done`: as for end_stopped; it may wait for a file that is being written.
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

/// Prints "stopped by Ctrl-C" (or SIGTERM) and the work done so far, and ends the command with the code of the signal.
[[noreturn]] void end_stopped(const std::string& done);

}  // namespace rvelab::cli
