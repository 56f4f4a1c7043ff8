// The default floating-point environment for as long as an object lives: to nearest, no flush to zero, no traps. What
// the host had, flags included, is put back at the end.
#pragma once

#include <cfenv>
#include <cstdint>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace rvelab::pool {

class FloatingPoint {
 public:
#if defined(__x86_64__)
  // The calls of fenv.h take 350 ns; a host that is in the default environment, as most are, pays 10.
  FloatingPoint() noexcept : vectors_(_mm_getcsr()) {
    whole_ = control() != 0x37F || flags() != 0;
    if (whole_) {
      std::fegetenv(&host_);
      std::fesetenv(FE_DFL_ENV);
    }
    _mm_setcsr(0x1F80);
  }
  ~FloatingPoint() {
    if (whole_)
      std::fesetenv(&host_);
    else if (flags() != 0)
      __asm__ volatile("fnclex");
    _mm_setcsr(vectors_);
  }
#else
  FloatingPoint() noexcept {
    std::fegetenv(&host_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatingPoint() { std::fesetenv(&host_); }
#endif
  FloatingPoint(const FloatingPoint&) = delete;
  FloatingPoint& operator=(const FloatingPoint&) = delete;

 private:
  std::fenv_t host_;
#if defined(__x86_64__)
  /// Control word and flags of the x87 unit.
  static std::uint16_t control() {
    std::uint16_t word = 0;
    __asm__ volatile("fnstcw %0" : "=m"(word));
    return word;
  }
  static std::uint16_t flags() {
    std::uint16_t word = 0;
    __asm__ volatile("fnstsw %0" : "=m"(word));
    return word & 0x7F;
  }

  std::uint32_t vectors_;  ///< MXCSR, of SSE and beyond
  bool whole_;             ///< host_ is needed
#endif
};

}  // namespace rvelab::pool
