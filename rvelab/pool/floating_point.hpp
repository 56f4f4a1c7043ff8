// The default floating-point environment for as long as an object lives: to nearest, no flush to zero, no traps. What
// the host had, flags included, is put back at the end.
#pragma once

#include <cfenv>
#include <cstdint>

namespace rvelab::pool {

class FloatingPoint {
 public:
  FloatingPoint() noexcept;
  ~FloatingPoint();
  FloatingPoint(const FloatingPoint&) = delete;
  FloatingPoint& operator=(const FloatingPoint&) = delete;

 private:
  std::fenv_t host_;
#if defined(__x86_64__)
  std::uint32_t vectors_ = 0;  ///< MXCSR, of SSE and beyond
  std::uint16_t flags_ = 0;    ///< of the x87 unit
  bool whole_ = false;         ///< host_ is needed
#endif
};

}  // namespace rvelab::pool
