// What the C++ library of emscripten 3.1 lacks of C++20, for a build without threads. Included before each file of the
// WebAssembly build (tools/cmake/wasm.cmake); goes with a newer emscripten.
#pragma once

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

namespace std {

template <class To, class From>
To bit_cast(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  memcpy(&to, &from, sizeof(To));
  return to;
}

template <class T>
unique_ptr<T> make_unique_for_overwrite(size_t count) {
  return unique_ptr<T>(new remove_extent_t<T>[count]);
}

/// One thread: any access is atomic.
template <class T>
struct atomic_ref {
  explicit atomic_ref(T& of) : of_(of) {}
  T load() const { return of_; }
  void store(T value) const { of_ = value; }

 private:
  T& of_;
};

/// The fewest digits that read back, in the form that the standard says: the shorter one, plain where both are alike.
inline to_chars_result to_chars(char* first, char* last, double value) {
  char digits[32], plain[400];
  int precision = 1;
  do snprintf(digits, sizeof digits, "%.*e", precision - 1, value);
  while (strtod(digits, nullptr) != value && value == value && ++precision <= 17);
  string text = digits;
  if (const auto e = text.find('e'); e != string::npos) {
    const int exponent = atoi(text.c_str() + e + 1), places = precision - 1 - exponent;
    snprintf(plain, sizeof plain, "%.*f", places > 0 ? places : 0, value);
    if (strlen(plain) <= text.size()) text = plain;
  }
  if (size_t(last - first) < text.size()) return {last, errc::value_too_large};
  memcpy(first, text.data(), text.size());
  return {first + text.size(), errc()};
}

inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const string text(first, last);
  if (text.empty() || text[0] == ' ' || text[0] == '+') return {first, errc::invalid_argument};
  char* end = nullptr;
  const double found = strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  value = found;
  return {first + (end - text.c_str()), errc()};
}

}  // namespace std
