// Preloaded (LD_PRELOAD) into the program under test: requests for memory that find none.
//
// RVELAB_NO_MEMORY_FROM=n in the environment: from the n-th on, no `new` finds memory.
// fail_requests(k, lasting): the k-th request of any kind from now on, on any thread, finds none, and if `lasting` no
// later one does; k = 0: all find some. A program that is to do without this library finds it by dlsym.
// fail_new_only(1): of these, `new` alone counts and fails; what libraries of C ask for is found.
// requests_made(): how many there were since. blocks_held(): those that were found and not given back.
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

// The allocator of glibc under the names that nothing stands in front of. Before a sanitizer's runtime, which must have
// its own, only `new` is replaced.
#if defined(RVELAB_SHIM_BEFORE_SANITIZER)
#define RVELAB_PLAIN(call) std::call
#else
#define RVELAB_PLAIN(call) __libc_##call
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}
#endif

namespace {

std::atomic<long> requests{0}, failing{0}, blocks{0};
std::atomic<bool> fails_on{false}, new_only{false};

/// Whether this request, of any kind, finds none.
bool fails() {
  const long from = failing;
  if (from == 0) return false;
  const long number = ++requests;
  if (number != from && !(fails_on && number > from)) return false;
  errno = ENOMEM;
  return true;
}

/// Whether this `new` finds none.
bool refused() {
  static std::atomic<long> calls{0};
  static const long from = [] {
    const char* const text = std::getenv("RVELAB_NO_MEMORY_FROM");
    return text == nullptr ? 0 : std::atol(text);
  }();
  return (from > 0 && ++calls >= from) || fails();
}

void* counted(void* found) {
  if (found != nullptr) ++blocks;
  return found;
}

void* new_block(std::size_t size) { return refused() ? nullptr : counted(RVELAB_PLAIN(malloc)(size == 0 ? 1 : size)); }

void give_back(void* at) {
  if (at != nullptr) --blocks;
  RVELAB_PLAIN(free)(at);
}

}  // namespace

extern "C" {
[[gnu::visibility("default")]] void fail_requests(long number, int lasting) {
  failing = 0;
  requests = 0;
  fails_on = lasting != 0;
  failing = number;
}
[[gnu::visibility("default")]] void fail_new_only(int only) { new_only = only != 0; }
[[gnu::visibility("default")]] long requests_made() { return requests; }
[[gnu::visibility("default")]] long blocks_held() { return blocks; }
}

#if !defined(RVELAB_SHIM_BEFORE_SANITIZER)
extern "C" {
void* malloc(std::size_t size) { return !new_only && fails() ? nullptr : counted(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) {
  return !new_only && fails() ? nullptr : counted(__libc_calloc(count, size));
}
void* realloc(void* at, std::size_t size) {
  if (!new_only && fails()) return nullptr;
  void* const found = __libc_realloc(at, size);
  if (at == nullptr) return counted(found);
  if (size == 0) --blocks;
  return found;
}
void* memalign(std::size_t edge, std::size_t size) {
  return !new_only && fails() ? nullptr : counted(__libc_memalign(edge, size));
}
void* aligned_alloc(std::size_t edge, std::size_t size) { return memalign(edge, size); }
int posix_memalign(void** at, std::size_t edge, std::size_t size) {
  void* const found = memalign(edge, size);
  if (found == nullptr) return ENOMEM;
  *at = found;
  return 0;
}
void free(void* at) { give_back(at); }
}
#endif

void* operator new(std::size_t size) {
  void* const found = new_block(size);
  if (found == nullptr) throw std::bad_alloc();
  return found;
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return new_block(size); }
void operator delete(void* at) noexcept { give_back(at); }
void operator delete(void* at, std::size_t) noexcept { give_back(at); }
