#include "tests/abi/no_memory.hpp"

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>

namespace rvelab::test {

thread_local long allocations_left = 0;
thread_local void (*meanwhile)() = nullptr;

namespace {

void* asked_for(std::size_t size, std::size_t edge = alignof(std::max_align_t)) noexcept {
  if (meanwhile != nullptr) std::exchange(meanwhile, nullptr)();
  if (allocations_left > 0 && --allocations_left == 0) return nullptr;
  const std::size_t whole = size == 0 ? edge : (size + edge - 1) / edge * edge;
  return std::aligned_alloc(edge, whole);
}

void* found(void* at) {
  if (at == nullptr) throw std::bad_alloc();
  return at;
}

}  // namespace
}  // namespace rvelab::test

using rvelab::test::asked_for, rvelab::test::found;

void* operator new(std::size_t size) { return found(asked_for(size)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return asked_for(size); }
void* operator new(std::size_t size, std::align_val_t edge) { return found(asked_for(size, std::size_t(edge))); }
// Where new is not inlined but delete is, gcc sees free() of what operator new returned: here both are malloc's.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void operator delete(void* at) noexcept { std::free(at); }
void operator delete(void* at, std::size_t) noexcept { std::free(at); }
void operator delete(void* at, std::align_val_t) noexcept { std::free(at); }
void operator delete(void* at, std::size_t, std::align_val_t) noexcept { std::free(at); }
