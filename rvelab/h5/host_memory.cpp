// Memory of C++ as librvelab.so asks for it. Values cross between the two libraries, and this one is loaded with its
// own symbols first (abi/file_library.cpp): where the host replaces operator new, it would get that of libstdc++.
#ifdef RVELAB_SHARED_HDF5
#include <dlfcn.h>

#include <cstddef>
#include <new>

namespace {

/// The function that the global symbols of the process have, else the next after this library's.
template <class Function>
Function* of_host(const char* name) noexcept {
  static void* const process = dlopen(nullptr, RTLD_LAZY);
  void* const found = dlsym(process, name);
  return reinterpret_cast<Function*>(found != nullptr ? found : dlsym(RTLD_NEXT, name));
}

}  // namespace

// All others of libstdc++ call these.

void* operator new(std::size_t size) {
  static auto* const call = of_host<void*(std::size_t)>("_Znwm");
  return call(size);
}

void* operator new(std::size_t size, std::align_val_t edge) {
  static auto* const call = of_host<void*(std::size_t, std::align_val_t)>("_ZnwmSt11align_val_t");
  return call(size, edge);
}

void operator delete(void* memory) noexcept {
  static auto* const call = of_host<void(void*)>("_ZdlPv");
  call(memory);
}

void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

void operator delete(void* memory, std::align_val_t edge) noexcept {
  static auto* const call = of_host<void(void*, std::align_val_t)>("_ZdlPvSt11align_val_t");
  call(memory, edge);
}

void operator delete(void* memory, std::size_t, std::align_val_t edge) noexcept { operator delete(memory, edge); }
#endif
