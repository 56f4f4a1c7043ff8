// Arrays of doubles on cache-line boundaries, so that no vector load straddles two lines; arrays that copies share.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace rvelab {

template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64))); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
  bool operator==(const CacheLineAllocator&) const { return true; }
};

using Buffer = std::vector<double, CacheLineAllocator<double>>;

/// An array that is set as a whole and shared by all copies: a thousand cells of one specimen hold its radii once.
template <class T>
class SharedArray {
 public:
  SharedArray() : values_(std::make_shared<const std::vector<T>>()) {}
  SharedArray& operator=(std::vector<T> values) {
    values_ = std::make_shared<const std::vector<T>>(std::move(values));
    return *this;
  }
  operator const std::vector<T>&() const { return *values_; }
  const T& operator[](std::size_t k) const { return (*values_)[k]; }
  const T* data() const { return values_->data(); }
  std::size_t size() const { return values_->size(); }
  auto begin() const { return values_->begin(); }
  auto end() const { return values_->end(); }

 private:
  std::shared_ptr<const std::vector<T>> values_;
};

}  // namespace rvelab
