// What a call of the pool led to; statuses and plain structs are those of include/rvelab/rvelab.h.
#pragma once

#include <cstdint>
#include <string>

#pragma GCC visibility push(default)  // what it declares is what librvelab.so exports
#include <rvelab/rvelab.h>
#pragma GCC visibility pop

#include "rvelab/error.hpp"

namespace rvelab::pool {

/// Enumerator and number of each status.
#define RVELAB_STATUSES(each)                                                                                      \
  each(ok, RVELAB_OK) each(tolerance_missed, RVELAB_W_TOLERANCE) each(not_quasi_static, RVELAB_W_NOT_QUASI_STATIC) \
      each(cell_thin, RVELAB_W_CELL_THIN) each(tangent_affine, RVELAB_W_TANGENT_AFFINE)                            \
          each(not_held, RVELAB_W_NOT_HELD) each(discard, RVELAB_DISCARD) each(bad_input, RVELAB_E_INPUT)          \
              each(null_pointer, RVELAB_E_NULL) each(bad_id, RVELAB_E_ID) each(stale_token, RVELAB_E_STALE)        \
                  each(duplicate, RVELAB_E_DUPLICATE) each(no_trial, RVELAB_E_NO_TRIAL) each(busy, RVELAB_E_BUSY)  \
                      each(forked, RVELAB_E_FORKED) each(no_memory, RVELAB_E_MEMORY)                               \
                          each(unsupported, RVELAB_E_UNSUPPORTED) each(small_buffer, RVELAB_E_BUFFER)              \
                              each(bad_snapshot, RVELAB_E_SNAPSHOT) each(bad_file, RVELAB_E_FILE)                  \
                                  each(no_library, RVELAB_E_LIBRARY) each(no_slot, RVELAB_E_LIMIT)                 \
                                      each(internal, RVELAB_E_INTERNAL) each(interrupted, RVELAB_E_INTERRUPTED)

#define RVELAB_ENUMERATOR(status, number) status = number,
enum class Status : std::int32_t { RVELAB_STATUSES(RVELAB_ENUMERATOR) };
#undef RVELAB_ENUMERATOR

constexpr bool is_error(Status status) { return status < Status::discard; }

/// Order of statuses: error > DISCARD > warning > OK.
constexpr int severity(Status status) {
  if (status == Status::ok) return 0;
  if (status > Status::ok) return 1;
  return status == Status::discard ? 2 : 3;
}

/// A call that is refused, or an RVE that could not be worked on; states are as they were.
struct Refused : Error {
  Refused(Status status, const std::string& text) : Error(text), status(status) {}
  Status status;
};

/// The status of the exception that is being handled, and its text (cut to fit, always ended); allocates nothing.
Status status_of_exception(char* text, std::size_t size) noexcept;

/// A status with its text, "" for ok.
struct Verdict {
  Status status = Status::ok;
  std::string text;
};
/// Of the exception that is being handled.
Verdict verdict_of_failure() noexcept;
/// Puts words before the text. Steps are made, and their statuses stand: without memory for words the text says less.
void put_before(Verdict& verdict, const char* words) noexcept;
/// The verdict of an entry of a call on many RVEs: its text, if there is one, names entry and id.
Verdict of_entry(Verdict verdict, std::int64_t entry, std::int64_t id) noexcept;

}  // namespace rvelab::pool
