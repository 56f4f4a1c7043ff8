// Time that the calling thread has spent on a processor: what a call costs, whatever else the machine does.
#pragma once

#include <ctime>

namespace rvelab::study {

inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace rvelab::study
