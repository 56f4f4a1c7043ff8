// Wall time, for what a step spends where.
#pragma once

#include <chrono>

namespace mpm {

/// s, from any fixed moment.
inline double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace mpm
