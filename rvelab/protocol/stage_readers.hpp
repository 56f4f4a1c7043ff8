// Readers of the kinds of stages, and what they share. Internal to the room.
#pragma once

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/protocol_keys.hpp"

namespace rvelab::protocol {

using keys::line_of;
using keys::TableReader;

inline constexpr double most_records = 1e6;

/// A stage's own pressure, or the test's.
double pressure_of(TableReader& reader, const std::string& name, Protocol& protocol);

/// A pressure that the stage holds nothing at.
void refuse_pressure(TableReader& reader, const std::string& name, const std::string& other);

/// record_every, for a stage that goes to `to_strain`.
double spacing_of(TableReader& reader, double to_strain);

DeviatoricStage read_deviatoric(TableReader& reader, Protocol& protocol);
PressurePathStage read_pressure_path(TableReader& reader);
PathStage read_path(TableReader& reader, const std::string& stage, const Protocol& protocol,
                    std::vector<KeyError>& errors);
FlowStage read_flow(TableReader& reader, const Protocol& protocol);
DeformationStage read_deformation(TableReader& reader, const Protocol& protocol);
EnvelopeStage read_envelope(TableReader& reader);

/// The events of a stage of this kind; their stages are looked up once all are read.
std::vector<Event> read_until(TableReader& reader, const std::string& stage, const std::string& kind,
                              std::vector<KeyError>& errors);

}  // namespace rvelab::protocol
