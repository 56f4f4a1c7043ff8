// Protocols written as text: their runs, and the messages of those that are refused.
#pragma once

#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/protocol/run.hpp"

namespace rvelab::test {

/// Stages at 20 kPa on a specimen.
inline protocol::TestRun run_stages(const std::string& stages, const Specimen& specimen) {
  return protocol::run_protocol(
      protocol::parse_protocol("[test]\nname = \"test\"\npressure_Pa = 20e3\n" + stages, "test.toml"), specimen);
}

/// The message of the InputError that the text gives; "" if it gives none.
inline std::string message_of(const std::string& text, const std::vector<std::string>& assignments = {}) {
  try {
    protocol::parse_protocol(text, "test.toml", assignments);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace rvelab::test
