// Ctrl-C and SIGTERM: the first asks the work to stop and put its results away, the second ends the program at once.
#pragma once

#include <atomic>
#include <string>

namespace rvelab::cli {

/// Takes both signals from here on. True once one has come.
const std::atomic<bool>& stop_on_signals();

/// Prints "stopped by Ctrl-C" (or SIGTERM) and what was done until then, and ends the command with the code of the
/// signal.
[[noreturn]] void end_stopped(const std::string& done);

}  // namespace rvelab::cli
