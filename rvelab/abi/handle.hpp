// A rvelab_pool* is a pool::Pool*. The struct of the header is never defined, so that no layout of a pool is part of the
// interface.
#pragma once

#include <span>

#include "rvelab/abi/header.hpp"
#include "rvelab/abi/wall.hpp"
#include "rvelab/pool/pool.hpp"

namespace rvelab::abi {

/// The pool of a handle; Refused (null_pointer) without one.
inline pool::Pool& pool_of(rvelab_pool* handle) {
  expect_pointer(handle, "pool");
  return *reinterpret_cast<pool::Pool*>(handle);
}

/// n ids. Refused (bad_input, null_pointer).
std::span<const std::int64_t> ids_of(std::int64_t n, const std::int64_t* ids);

}  // namespace rvelab::abi
