// The table of the kinds of stages. The key stage.kind, the keys of each kind, reading, running and calibration use it.
// Internal to the room.
#pragma once

#include <memory>
#include <vector>

#include "rvelab/protocol/stage_kind.hpp"

namespace rvelab::protocol {

/// Makes a stage of a kind, with its default settings.
using MakeStage = std::unique_ptr<StageKind>();

// Each in stage_NAME.cpp.
MakeStage isotropic_kind, compression_kind, simple_shear_kind, pressure_path_kind, deviatoric_kind, path_kind,
    flow_kind, deformation_kind, envelope_kind, relax_kind, probe_kind;

/// Every kind, in the order in which keys and messages list them.
inline constexpr MakeStage* stage_kinds[] = {isotropic_kind,  compression_kind, simple_shear_kind, pressure_path_kind,
                                             deviatoric_kind, path_kind,        flow_kind,         deformation_kind,
                                             envelope_kind,   relax_kind,       probe_kind};

/// A stage of the kind of this name. std::logic_error if there is none.
std::unique_ptr<StageKind> stage_of_kind(const std::string& name);

/// Names of the kinds whose stages events can end, or cannot, "a, b, c".
std::string kinds_with_events(bool taking);

}  // namespace rvelab::protocol
