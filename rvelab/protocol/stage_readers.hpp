// What readers of several kinds of stages share. Internal to the room.
#pragma once

#include <string>

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/protocol.hpp"

namespace rvelab::protocol {

inline constexpr double most_records = 1e6;

/// A stage's own pressure, or the test's.
double pressure_of(keys::TableReader& reader, const std::string& name, Protocol& protocol);

/// A pressure that the stage holds nothing at.
void refuse_pressure(keys::TableReader& reader, const std::string& name, const std::string& other);

/// record_every, for a stage that goes to `to_strain`.
double spacing_of(keys::TableReader& reader, double to_strain);

}  // namespace rvelab::protocol
