// What a rvelab_pool is behind the interface.
#pragma once

#include "rvelab/abi/header.hpp"
#include "rvelab/abi/wall.hpp"
#include "rvelab/pool/pool.hpp"

struct rvelab_pool {
  explicit rvelab_pool(const rvelab::pool::Options& options) : pool(options) {}
  rvelab::pool::Pool pool;
};

namespace rvelab::abi {

/// The pool of a handle; Refused (null_pointer) without one.
inline pool::Pool& pool_of(rvelab_pool* handle) {
  expect_pointer(handle, "pool");
  return handle->pool;
}

/// n ids. Refused (bad_input, null_pointer).
std::span<const std::int64_t> ids_of(std::int64_t n, const std::int64_t* ids);

}  // namespace rvelab::abi
