// The stages of a protocol, read from their tables. Internal to the room.
#pragma once

#include "rvelab/keys/key.hpp"
#include "rvelab/protocol/protocol.hpp"

namespace rvelab::protocol {

/// Reads one [[stage]] into protocol.stages and its resolved table into `resolved`. Mistakes go to `errors`.
void read_stage(const toml::table& table, long number, Protocol& protocol, toml::array& resolved,
                std::vector<keys::KeyError>& errors);

}  // namespace rvelab::protocol
