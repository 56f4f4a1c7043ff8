// The boundary between a host in C and the library: inside, the default floating-point environment and the locale of C;
// outside, a status and a text in the place of exceptions.
//
// A rvelab_pool* is a pool::Pool*. The struct of the header is never defined, so that no layout of a pool is part of
// the interface.
#pragma once

#include <span>

#include "rvelab/h5/file_calls.hpp"
#include "rvelab/pool/floating_point.hpp"
#include "rvelab/pool/threaded_pool.hpp"
#include "rvelab/threads/classic_locale.hpp"

namespace rvelab::abi {

/// Records the text for rvelab_last_error; returns the status as a number.
std::int32_t recorded(const pool::Verdict& verdict) noexcept;
/// The same of the exception that is being handled.
std::int32_t recorded_failure() noexcept;

/// Runs `call`, which returns a pool::Verdict or nothing (ok).
template <class Call>
std::int32_t at_c_boundary(Call&& call) noexcept {
  const pool::FloatingPoint environment;
  const ClassicLocale locale;
  try {
    if constexpr (std::is_void_v<decltype(call())>) {
      call();
      return 0;
    } else {
      const pool::Verdict verdict = call();
      return verdict.status == pool::Status::ok ? 0 : recorded(verdict);
    }
  } catch (...) {
    return recorded_failure();
  }
}

/// An argument that must not be null.
struct Needed {
  const void* pointer;
  const char* name;
};
/// Throws Refused (null_pointer) naming the first that is null.
void expect_pointers(std::initializer_list<Needed> needed);
/// n ids. Refused (bad_input, null_pointer).
std::span<const std::int64_t> ids_of(std::int64_t n, const std::int64_t* ids);

/// Runs call(pool) of the pool of a handle, with these arguments.
template <class Call>
std::int32_t of_pool(rvelab_pool* handle, std::initializer_list<Needed> needed, const Call& call) noexcept {
  return at_c_boundary([&] {
    expect_pointers({{handle, "pool"}});
    expect_pointers(needed);
    return call(*reinterpret_cast<pool::Pool*>(handle));
  });
}

// Files, and texts of TOML, by way of librvelab-h5.so, which is loaded at the first call for one: found beside the
// library that this code is in, then as the loader finds it. Throws pool::Refused: no_library, or what the file led to.

/// The specimen of a specimen file, or the end state of a record file.
Specimen read_specimen(const std::string& path);
void write_pool(pool::Pool& pool, const std::string& path);
void read_pool(pool::Pool& pool, const std::string& path);
/// All that the library does.
const h5::FileCalls& file_calls();
/// The same, where a text is to be read: toml++ ends the process where memory runs out while it unwinds, so what it
/// will take is asked for before.
const h5::FileCalls& text_calls(const std::string& text);

// librvelab.so makes the share of a rank for librvelab-mpi.so, of the same version, and hands its pool to the host. No
// part of the interface of the host.

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
