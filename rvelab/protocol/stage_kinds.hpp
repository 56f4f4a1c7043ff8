// What a kind of stage is: its keys, how they are read, how a test is driven by them; and the table of all kinds, which
// the key stage.kind, reading, running and calibration use. Internal to the module.
//
// A new kind is one file stage_NAME.cpp with a class of its settings and a function NAME_kind() that makes one, and its
// line here. Interactions that form by themselves have one each without a line (stage_forming.cpp).
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "rvelab/interaction/laws.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/protocol.hpp"

namespace rvelab::protocol {

class RunningTest;

/// A kind of stage, with the settings of one stage of it.
class StageKind {
 public:
  virtual ~StageKind() = default;

  virtual const char* name() const = 0;  ///< stage.kind; its keys stand in the table "stage.NAME" and below it
  /// Reads every key of the kind, whatever the others say, since so they are documented. `protocol`: what was read of
  /// it before (dimension, pressure). If a mistake is added, the settings are not used.
  virtual void read(keys::TableReader& reader, Protocol& protocol) = 0;
  /// From phase 1 to the end of the stage, or on from where run.progress says that it is (drive.hpp).
  virtual void drive(RunningTest& test) const = 0;
  /// Records that it makes where no event ends it.
  virtual std::size_t planned_records() const { return 0; }
  /// Why it does not go with specimens of this dimension, with the remedy; "": it does.
  virtual std::string misfit(int /*dimension*/) const { return ""; }
  /// What it names and the specimen has not, with the remedy; "": nothing.
  virtual std::string lacking_in(const Specimen& /*specimen*/) const { return ""; }
  /// What of its settings lies outside the tables and formulas that it uses, for the grains of this specimen; a line
  /// each.
  virtual std::vector<std::string> outside_ranges(const Specimen& /*specimen*/) const { return {}; }
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

/// Makes a stage of a kind, with its default settings.
using MakeStage = std::unique_ptr<StageKind>();

// Each in stage_NAME.cpp.
MakeStage isotropic_kind, compression_kind, simple_shear_kind, pressure_path_kind, deviatoric_kind, path_kind,
    flow_kind, deformation_kind, envelope_kind, relax_kind, probe_kind, cement_kind, dissolve_kind;
/// Of what interactions form from, by the place of their law among those that form by themselves (stage_forming.cpp).
std::unique_ptr<StageKind> forming_kind(int which);
template <int which>
std::unique_ptr<StageKind> forming_kind_of() {
  return forming_kind(which);
}

template <std::size_t count, int... which>
constexpr auto with_forming_kinds(const std::array<MakeStage*, count>& own, std::integer_sequence<int, which...>) {
  std::array<MakeStage*, count + sizeof...(which)> all{};
  std::size_t k = 0;
  for (MakeStage* const make : own) all[k++] = make;
  ((all[k++] = &forming_kind_of<which>), ...);
  return all;
}

/// Every kind, in the order in which keys and messages list them.
inline constexpr auto stage_kinds = with_forming_kinds(
    std::array<MakeStage*, 13>{isotropic_kind, compression_kind, simple_shear_kind, pressure_path_kind, deviatoric_kind,
                               path_kind, flow_kind, deformation_kind, envelope_kind, relax_kind, probe_kind,
                               cement_kind, dissolve_kind},
    std::make_integer_sequence<int, forming_laws(InteractionLaws{})>());

/// A stage of the kind of this name. std::logic_error if there is none.
std::unique_ptr<StageKind> stage_of_kind(const std::string& name);

/// Names of the kinds whose stages events can end, or cannot, "a, b, c".
std::string kinds_with_events(bool taking);

}  // namespace rvelab::protocol
