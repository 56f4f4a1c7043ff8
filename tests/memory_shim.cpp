// Preloaded (LD_PRELOAD) into the program under test: from the RVELAB_NO_MEMORY_FROM-th on, no `new` finds memory.
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

bool refused() {
  static std::atomic<long> calls{0};
  static const long from = [] {
    const char* const text = std::getenv("RVELAB_NO_MEMORY_FROM");
    return text == nullptr ? 0 : std::atol(text);
  }();
  return from > 0 && ++calls >= from;
}

}  // namespace

void* operator new(std::size_t size) {
  void* const found = refused() ? nullptr : std::malloc(size == 0 ? 1 : size);
  if (found == nullptr) throw std::bad_alloc();
  return found;
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return refused() ? nullptr : std::malloc(size == 0 ? 1 : size);
}
void operator delete(void* at) noexcept { std::free(at); }
void operator delete(void* at, std::size_t) noexcept { std::free(at); }
