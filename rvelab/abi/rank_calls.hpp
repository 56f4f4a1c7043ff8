// librvelab.so makes the share of a rank for librvelab-mpi.so, of the same version, and hands its pool to the host. No
// part of the interface of the host.
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
  /// Gives the host the pool, or null, that make(self, options) returns; options() reads def. An exception becomes the
  /// status and the text of the call.
  std::int32_t (*give_pool)(const rvelab_pool_def* def, void* self, MakePool make, rvelab_pool** pool) noexcept;
};

}  // namespace rvelab::abi

/// A rvelab::abi::RankCalls; as void it keeps private types out of the interface that is held stable.
extern "C" [[gnu::visibility("default")]] const void* rvelab_rank_calls();
