// Events: conditions that end a stage early. Internal to the room.
#pragma once

#include <string>
#include <vector>

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/drive.hpp"

namespace rvelab::protocol {

/// A quantity that an event may check.
struct EventQuantity {
  const char* name;
  double (*value)(const RunningTest&);
};

/// Those of a running test, and every number of the table of measured quantities (rvelab/records/quantities.hpp).
const std::vector<EventQuantity>& event_quantities();

/// Keys of [[stage.until]].
std::vector<keys::TableKey> event_keys();

/// The events of a stage; the stages that they name are looked up once all are read.
std::vector<Event> read_events(keys::TableReader& reader, const Stage& stage, std::vector<keys::KeyError>& errors);

/// The first event of the stage that its last record meets, from 0; -1: none. Renews progress.largest.
int met_event(RunningTest& test, const Stage& stage);

}  // namespace rvelab::protocol
