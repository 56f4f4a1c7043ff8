/* For portable programs (tools/cmake/portable.cmake): two functions that glibc gave a new version, in the version that every
 * glibc has, so that programs linked against 2.36 start with 2.34. The linker sends calls here (--wrap). */
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

/* 2.35 dropped the setting of errno, which rvelab does not read; the arithmetic is that of the glibc of the user. */
double hypot_of_any_glibc(double, double);
__asm__(".symver hypot_of_any_glibc, hypot@" RVELAB_OLDEST_GLIBC);
double __wrap_hypot(double x, double y);
double __wrap_hypot(double x, double y) { return hypot_of_any_glibc(x, y); }

/* 2.36; the seeds of libstdc++'s random_device, which rvelab does not ask for any. */
uint32_t __wrap_arc4random(void);
uint32_t __wrap_arc4random(void) {
  uint32_t drawn;
  if (getentropy(&drawn, sizeof drawn) != 0) abort();
  return drawn;
}
