// librvelab-h5.so reads and writes files for librvelab.so. Plain functions and bytes cross between the two: specimens
// as of Rve::save(), states of a pool as of pool::to_bytes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rvelab::h5 {

/// Where bytes go, or the text of a failure; called during the call that it is given to.
struct Receiver {
  void* self = nullptr;
  void (*take)(void* self, const void* bytes, std::size_t size) = nullptr;  ///< must not throw
};

/// A pool as numbers; the arrays belong to who hands it over.
struct PoolNumbers {
  std::uint32_t tag = 0;
  const std::uint32_t* generations = nullptr;
  std::size_t slots = 0;
  const std::int64_t* ids = nullptr;
  std::size_t rves = 0;
};

/// Gives the bytes of the k-th RVE to a receiver; false: it could not, and the writing ends.
struct StateSource {
  void* self = nullptr;
  bool (*give)(void* self, std::size_t k, const Receiver& to) = nullptr;
};

/// Takes the numbers of a pool.
struct PoolReceiver {
  void* self = nullptr;
  void (*take)(void* self, const PoolNumbers& pool) = nullptr;
};

/// Each call returns a status (pool::Status) and, if it is not ok, gives a text to `failure`.
struct FileCalls {
  const char* version;  ///< of rvelab; both libraries must be of one
  std::int32_t (*read_specimen)(const char* path, const Receiver& specimen, const Receiver& failure) noexcept;
  std::int32_t (*write_pool)(const char* path, const PoolNumbers& pool, const StateSource& states,
                             const Receiver& failure) noexcept;
  /// The states first, in the order of the ids, then the numbers.
  std::int32_t (*read_pool)(const char* path, const Receiver& state, const PoolReceiver& pool,
                            const Receiver& failure) noexcept;
};

/// Name of the function that librvelab-h5.so exports.
constexpr const char* file_calls_name = "rvelab_h5_file_calls";
using GetFileCalls = const FileCalls* (*)();

}  // namespace rvelab::h5

extern "C" [[gnu::visibility("default")]] const rvelab::h5::FileCalls* rvelab_h5_file_calls();
