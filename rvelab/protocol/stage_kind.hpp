// What a kind of stage is: its keys, how its settings are read, and how a test is driven by them. Internal to the room.
//
// A kind is one file stage_NAME.cpp with a function NAME_kind() that fills a KindOf of its settings, and its line in
// the table (stage_kinds.hpp).
#pragma once

#include <any>
#include <functional>
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

/// A kind of stage with the type of its settings hidden.
struct StageKind {
  std::string name;  ///< stage.kind; its keys stand in the table "stage.NAME" and in those below it
  std::vector<keys::TableKey> keys;
  std::function<std::any(StageSource&)> read;
  std::function<void(RunningTest&, const std::any&)> drive;
  std::function<std::size_t(const std::any&)> planned_records;
  std::function<std::string(const std::any&, int dimension)> misfit;
  std::function<StageRole(const std::any&)> role;
  std::string strength_when;
  bool takes_events = true;
};

/// A kind of stage; what has a default may be left out.
template <class Settings>
struct KindOf {
  const char* name;
  std::vector<keys::TableKey> (*keys)();
  /// Reads every key of the kind. Mistakes are booked, and what is returned is then not used.
  Settings (*read)(StageSource& source);
  /// From phase 1 to the end of the stage, or on from where run.progress says that it is (drive.hpp).
  void (*drive)(RunningTest& test, const Settings& settings);
  /// Records that it makes where no event ends it.
  std::size_t (*planned_records)(const Settings& settings) = [](const Settings&) -> std::size_t { return 0; };
  /// Why it does not go with specimens of this dimension, with the remedy; "": it does.
  std::string (*misfit)(const Settings& settings, int dimension) = [](const Settings&, int) { return std::string(); };
  /// What calibration may read from its records.
  StageRole (*role)(const Settings& settings) = [](const Settings&) { return StageRole{}; };
  const char* strength_when = "";  ///< settings with which that is a strength, in words; "": never
  bool takes_events = true;        ///< it makes records on its way, which events can look at

  operator StageKind() const {
    const auto settings_of = [](const std::any& what) -> const Settings& { return *std::any_cast<Settings>(&what); };
    return {name,
            keys(),
            [read = read](StageSource& source) { return std::any(read(source)); },
            [settings_of, drive = drive](RunningTest& test, const std::any& what) { drive(test, settings_of(what)); },
            [settings_of, planned = planned_records](const std::any& what) { return planned(settings_of(what)); },
            [settings_of, misfit = misfit](const std::any& what, int dimension) {
              return misfit(settings_of(what), dimension);
            },
            [settings_of, role = role](const std::any& what) { return role(settings_of(what)); },
            strength_when,
            takes_events};
  }
};

}  // namespace rvelab::protocol
