// Version of rvelab and the compiler that built it: what `rvelab --version` and the provenance of a file say.
#pragma once

#include <string>

namespace rvelab::io {

/// Version of the library and the program, major.minor.patch.
inline constexpr const char* version = "2.0.0";

/// Name and version of the compiler, for example "gcc 12.2.0".
inline std::string compiler() {
#if defined(__clang__)
  return std::string("clang ") + __clang_version__;
#else
  return std::string("gcc ") + __VERSION__;
#endif
}

}  // namespace rvelab::io
