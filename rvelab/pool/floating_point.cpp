#include "rvelab/pool/floating_point.hpp"

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace rvelab::pool {

#if defined(__x86_64__)

namespace {

constexpr std::uint32_t default_vectors = 0x1F80;
constexpr std::uint16_t default_unit = 0x37F, unit_flags = 0x7F;

std::uint16_t unit_control() {
  std::uint16_t word = 0;
  __asm__ volatile("fnstcw %0" : "=m"(word));
  return word;
}
std::uint16_t unit_status() {
  std::uint16_t word = 0;
  __asm__ volatile("fnstsw %0" : "=m"(word));
  return std::uint16_t(word & unit_flags);
}

}  // namespace

// The calls of fenv.h take 350 ns; a host that is in the default environment, as most are, pays 10.
FloatingPoint::FloatingPoint() noexcept : vectors_(_mm_getcsr()), flags_(unit_status()) {
  whole_ = unit_control() != default_unit || flags_ != 0;
  if (whole_) {
    std::fegetenv(&host_);
    std::fesetenv(FE_DFL_ENV);
  }
  _mm_setcsr(default_vectors);
}

FloatingPoint::~FloatingPoint() {
  if (whole_) {
    std::fesetenv(&host_);
  } else if (unit_status() != 0) {
    __asm__ volatile("fnclex");
  }
  _mm_setcsr(vectors_);
}

#else

FloatingPoint::FloatingPoint() noexcept {
  std::fegetenv(&host_);
  std::fesetenv(FE_DFL_ENV);
}
FloatingPoint::~FloatingPoint() { std::fesetenv(&host_); }

#endif

}  // namespace rvelab::pool
