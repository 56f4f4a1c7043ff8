// While an object exists, this thread writes and reads numbers in the C locale (1.5, not 1,5), independent of the
// host's setlocale. Streams follow std::locale::global instead: rvelab/error.hpp.
#pragma once

#include <locale.h>

namespace rvelab {

class ClassicLocale {
 public:
  ClassicLocale() noexcept : before_(uselocale(classic())) {}
  ~ClassicLocale() { uselocale(before_); }
  ClassicLocale(const ClassicLocale&) = delete;
  ClassicLocale& operator=(const ClassicLocale&) = delete;

 private:
  static locale_t classic() noexcept {
    static const locale_t made = newlocale(LC_ALL_MASK, "C", locale_t());
    return made;
  }
  locale_t before_;
};

}  // namespace rvelab
