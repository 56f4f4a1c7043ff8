// Events: what ends a stage before its end. Internal to the room.
#pragma once

#include <string>
#include <vector>

#include "rvelab/protocol/drive.hpp"

namespace rvelab::protocol {

/// A quantity that an event may look at, and what it is.
struct EventQuantity {
  const char* name;
  double (*value)(const RunningTest&);
};

const std::vector<EventQuantity>& event_quantities();

/// The first event of the stage that its last record meets, from 0; -1: none. Renews progress.largest.
int met_event(RunningTest& test, const Stage& stage);

}  // namespace rvelab::protocol
