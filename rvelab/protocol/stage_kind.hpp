// What a kind of stage is: its keys, how its settings are read, and how a test is driven by them. Internal to the room.
//
// A new kind is one file stage_NAME.cpp with a class of its settings and a function NAME_kind() that makes one, and its
// line in stage_kinds.hpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/protocol.hpp"

namespace rvelab::protocol {

class RunningTest;

/// Where the settings of a stage are read from.
struct StageSource {
  const toml::table& table;
  keys::TableReader& reader;            ///< of `table`
  const std::string& name;              ///< of the stage
  Protocol& protocol;                   ///< what was read of it before: dimension, pressure
  std::vector<keys::KeyError>& errors;  ///< mistakes that are not those of one key
};

/// A kind of stage, with the settings of one stage of it.
class StageKind {
 public:
  virtual ~StageKind() = default;

  virtual const char* name() const = 0;  ///< stage.kind; its keys stand in the table "stage.NAME" and below it
  virtual std::vector<keys::TableKey> keys() const = 0;
  /// Reads every key of the kind. If a mistake is added to the source's errors, the settings are not used.
  virtual void read(StageSource& source) = 0;
  /// From phase 1 to the end of the stage, or on from where run.progress says that it is (drive.hpp).
  virtual void drive(RunningTest& test) const = 0;
  /// Records that it makes where no event ends it.
  virtual std::size_t planned_records() const { return 0; }
  /// Why it does not go with specimens of this dimension, with the remedy; "": it does.
  virtual std::string misfit(int /*dimension*/) const { return ""; }
  /// What calibration may read from its records.
  virtual StageRole role() const { return {}; }
  /// Settings with which that is a strength, in words; "": never.
  virtual const char* strength_when() const { return ""; }
  /// Whether it makes records at which events can be checked.
  virtual bool takes_events() const { return true; }
};

/// A kind with its settings.
template <class Settings>
struct KindOf : StageKind {
  Settings stage;
};

/// The settings of a stage; null if it is of another kind.
template <class Settings>
const Settings* settings_of(const Stage& stage) {
  const auto* kind = dynamic_cast<const KindOf<Settings>*>(stage.what.get());
  return kind == nullptr ? nullptr : &kind->stage;
}

}  // namespace rvelab::protocol
