// Memory of C++ as librvelab.so asks for it. Values cross between the two libraries, and this one may be loaded with
// its own symbols first (abi/file_library.cpp): where the host replaces operator new, it would get that of libstdc++,
// and so would the libraries that come with it, for which these are exported.
#ifdef RVELAB_SHARED_HDF5
#include <dlfcn.h>

#include <cstddef>
#include <new>

namespace {

/// What the global symbols of the process have in the place of `own`, else the next after this library's.
template <class Function>
Function* of_host(const char* name, Function* own) noexcept {
  static void* const process = dlopen(nullptr, RTLD_LAZY);
  auto* const found = reinterpret_cast<Function*>(dlsym(process, name));
  return found != nullptr && found != own ? found : reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// All others of libstdc++ call these.
#pragma GCC visibility push(default)

void* operator new(std::size_t size) {
  static auto* const call = of_host<void*(std::size_t)>("_Znwm", &operator new);
  return call(size);
}

void* operator new(std::size_t size, std::align_val_t edge) {
  static auto* const call = of_host<void*(std::size_t, std::align_val_t)>("_ZnwmSt11align_val_t", &operator new);
  return call(size, edge);
}

void operator delete(void* memory) noexcept {
  static auto* const call = of_host<void(void*) noexcept>("_ZdlPv", &operator delete);
  call(memory);
}

void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

void operator delete(void* memory, std::align_val_t edge) noexcept {
  static auto* const call = of_host<void(void*, std::align_val_t) noexcept>("_ZdlPvSt11align_val_t", &operator delete);
  call(memory, edge);
}

void operator delete(void* memory, std::size_t, std::align_val_t edge) noexcept { operator delete(memory, edge); }

#pragma GCC visibility pop
#endif
