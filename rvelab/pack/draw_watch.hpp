// What a draw is watched by: progress, and the request to stop.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <utility>

#include "rvelab/error.hpp"

namespace rvelab::pack {

struct DrawWatch {
  const std::atomic<bool>* stop = nullptr;           ///< true: the draw throws Interrupted
  std::function<void(const std::string&)> on_phase;  ///< "scattering the grains, 40 %"; on any thread

  DrawWatch(const std::atomic<bool>* stopped = nullptr, std::function<void(const std::string&)> told = {})
      : stop(stopped), on_phase(std::move(told)) {}
  /// A moment of a phase, of which a part from 0 to 1 is done.
  void at(const char* phase, double part) const {
    tell(phase, [&] { return std::to_string(int(100 * part)) + " %"; });
  }
  /// The same, after so many sub-steps.
  void after(const char* phase, long substeps) const {
    tell(phase, [&] { return std::to_string(substeps) + " sub-steps"; });
  }

 private:
  template <class Words>
  void tell(const char* phase, const Words& words) const {
    if (stop != nullptr && stop->load(std::memory_order_relaxed)) throw Interrupted();
    if (on_phase) on_phase(std::string(phase) + ", " + words());
  }
};

}  // namespace rvelab::pack
