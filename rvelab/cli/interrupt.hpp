// Ctrl-C and SIGTERM: the first asks the work to stop and put its results away, the second ends the program at once.
#pragma once

#include <atomic>
#include <string>

namespace rvelab::cli {

/// Takes both signals from here on. True once one has come.
const std::atomic<bool>& stop_on_signals();

/// The signal that came; 0: none.
int signal_received();
/// "Ctrl-C" or "SIGTERM".
std::string signal_name();

}  // namespace rvelab::cli
