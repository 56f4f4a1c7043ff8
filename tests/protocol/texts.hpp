// Protocols written as text: their runs, and the messages of those that are refused.
#pragma once

#include <string>
#include <vector>

#include "rvelab/protocol/run.hpp"
#include "tests/refusal.hpp"

namespace rvelab::test {

/// Stages at 20 kPa on a specimen.
inline protocol::TestRun run_stages(const std::string& stages, const Specimen& specimen) {
  return protocol::run_protocol(
      protocol::parse_protocol("[test]\nname = \"test\"\npressure_Pa = 20e3\n" + stages, "test.toml"), specimen);
}

/// The message of the InputError that the text gives; "" if it gives none.
inline std::string message_of(const std::string& text, const std::vector<std::string>& assignments = {}) {
  return input_error([&] { protocol::parse_protocol(text, "test.toml", assignments); });
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace rvelab::test
