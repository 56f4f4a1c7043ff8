// What librvelab.so does for librvelab-mpi.so, which is of the same version: makes the share of a rank, and hands a
// pool to the host behind the wall. No part of the interface of the host.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "rvelab/pool/threaded_pool.hpp"

extern "C" {
struct rvelab_pool;
struct rvelab_pool_def;
}

namespace rvelab::abi {

using MakePool = std::unique_ptr<pool::Pool> (*)(void* self, const std::function<pool::Options()>& options);

struct RankCalls {
  const char* version;  ///< of rvelab; both libraries must be of one
  std::unique_ptr<pool::Share> (*open_share)(const pool::Options& options);
  /// Gives the pool that make(self, options) returns to the host, or null; options() reads def. What is thrown becomes
  /// the status and the text of the call.
  std::int32_t (*give_pool)(const rvelab_pool_def* def, void* self, MakePool make, rvelab_pool** pool) noexcept;
};

}  // namespace rvelab::abi

/// A rvelab::abi::RankCalls, said without its type: what is private stays out of the interface that is held stable.
extern "C" [[gnu::visibility("default")]] const void* rvelab_rank_calls();
