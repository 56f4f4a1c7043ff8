// What the hosts that are timed share.
#pragma once

#include <rvelab/rvelab.h>
#include <time.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>

/// Processor time of all threads of this process, s: other work on the machine is not in it.
inline double now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// Ends the host, with the text of the library, if a call failed.
inline void expect(std::int32_t status) {
  if (status >= RVELAB_OK) return;
  std::fprintf(stderr, "%s: %s\n", rvelab_status_name(status), rvelab_last_error());
  std::exit(1);
}
