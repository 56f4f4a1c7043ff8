// Version, capabilities, names of statuses, the last text. Declared in handle.hpp.
#include "rvelab/abi/c_boundary.hpp"
#include "rvelab/abi/handle.hpp"
#include "rvelab/io/version.hpp"

namespace rvelab::abi {

namespace {

struct Name {
  pool::Status status;
  std::int32_t number;
  const char* name;
};

#define RVELAB_NAMED(status, macro) \
  Name { pool::Status::status, macro, #macro }
constexpr Name names[] = {
    RVELAB_NAMED(ok, RVELAB_OK),
    RVELAB_NAMED(tolerance_missed, RVELAB_W_TOLERANCE),
    RVELAB_NAMED(not_quasi_static, RVELAB_W_NOT_QUASI_STATIC),
    RVELAB_NAMED(cell_thin, RVELAB_W_CELL_THIN),
    RVELAB_NAMED(tangent_affine, RVELAB_W_TANGENT_AFFINE),
    RVELAB_NAMED(discard, RVELAB_DISCARD),
    RVELAB_NAMED(bad_input, RVELAB_E_INPUT),
    RVELAB_NAMED(null_pointer, RVELAB_E_NULL),
    RVELAB_NAMED(bad_id, RVELAB_E_ID),
    RVELAB_NAMED(stale_token, RVELAB_E_STALE),
    RVELAB_NAMED(duplicate, RVELAB_E_DUPLICATE),
    RVELAB_NAMED(no_trial, RVELAB_E_NO_TRIAL),
    RVELAB_NAMED(busy, RVELAB_E_BUSY),
    RVELAB_NAMED(forked, RVELAB_E_FORKED),
    RVELAB_NAMED(no_memory, RVELAB_E_MEMORY),
    RVELAB_NAMED(unsupported, RVELAB_E_UNSUPPORTED),
    RVELAB_NAMED(small_buffer, RVELAB_E_BUFFER),
    RVELAB_NAMED(bad_snapshot, RVELAB_E_SNAPSHOT),
    RVELAB_NAMED(bad_file, RVELAB_E_FILE),
    RVELAB_NAMED(no_library, RVELAB_E_LIBRARY),
    RVELAB_NAMED(no_slot, RVELAB_E_LIMIT),
    RVELAB_NAMED(internal, RVELAB_E_INTERNAL),
};
#undef RVELAB_NAMED

constexpr bool numbers_agree() {
  for (const Name& name : names)
    if (std::int32_t(name.status) != name.number) return false;
  return true;
}
static_assert(numbers_agree(), "pool::Status and rvelab.h number a status differently");

}  // namespace
}  // namespace rvelab::abi

using namespace rvelab;

int32_t rvelab_abi_version(void) { return RVELAB_ABI_MAJOR << 16 | RVELAB_ABI_MINOR; }

const char* rvelab_version(void) { return io::version; }

int64_t rvelab_capabilities(void) {
  return RVELAB_CAN_PLANE | RVELAB_CAN_SPACE | RVELAB_CAN_TANGENT | RVELAB_CAN_ERROR_ESTIMATE | RVELAB_CAN_HOST_TASKS |
         RVELAB_CAN_FILES;
}

const char* rvelab_status_name(int32_t status) {
  for (const auto& name : abi::names)
    if (name.number == status) return name.name;
  return "unknown status";
}

const char* rvelab_last_error(void) { return abi::last_text(); }
