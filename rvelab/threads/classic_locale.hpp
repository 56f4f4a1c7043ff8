// Numbers in text as C writes and reads them, 1.5 and not 1,5, whatever locale a host has set (setlocale): in this
// thread, for as long as an object lives. Of streams, which follow std::locale::global: rvelab/error.hpp.
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
