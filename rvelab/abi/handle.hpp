// include/rvelab/rvelab.h as the library itself sees it: what it declares is what librvelab.so exports.
//
// A rvelab_pool* is a pool::Pool*. The struct of the header is never defined, so that no layout of a pool is part of
// the interface.
#pragma once

#include <span>

#pragma GCC visibility push(default)
#include <rvelab/rvelab.h>
#pragma GCC visibility pop

#include "rvelab/abi/c_boundary.hpp"
#include "rvelab/pool/threaded_pool.hpp"

namespace rvelab::abi {

/// The pool of a handle; Refused (null_pointer) without one.
inline pool::Pool& pool_of(rvelab_pool* handle) {
  expect_pointer(handle, "pool");
  return *reinterpret_cast<pool::Pool*>(handle);
}

/// n ids. Refused (bad_input, null_pointer).
std::span<const std::int64_t> ids_of(std::int64_t n, const std::int64_t* ids);

}  // namespace rvelab::abi
