// Stages of a test, as text of TOML, on a specimen.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::h5 {

/// InputError where they are not stages, or wrong in themselves.
void check_stages(const std::string& text);

/// Runs them as `rvelab run` does; the specimen becomes its end state. The text is that of a protocol; [test] may be
/// missing. Returns the grain-steps made. InputError: keys, values, what does not go with the specimen.
/// IncrementFailed: a stage cannot be carried out. Interrupted: `stop` came true. The specimen is then as it was.
std::int64_t run_stages(Specimen& specimen, const std::string& text, const std::atomic<bool>& stop);

}  // namespace rvelab::h5
