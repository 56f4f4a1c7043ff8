// The table of the kinds of stages. The key stage.kind, the keys of each kind, reading, running and calibration live
// from it. Internal to the room.
#pragma once

#include <vector>

#include "rvelab/protocol/stage_kind.hpp"

namespace rvelab::protocol {

// Each in stage_NAME.cpp.
StageKind isotropic_kind();
StageKind compression_kind();
StageKind simple_shear_kind();
StageKind pressure_path_kind();
StageKind deviatoric_kind();
StageKind path_kind();
StageKind flow_kind();
StageKind deformation_kind();
StageKind envelope_kind();
StageKind relax_kind();
StageKind probe_kind();

/// Every kind, in the order in which keys and messages list them. Made at the first call, whatever static objects there
/// are.
inline const std::vector<StageKind>& stage_kinds() {
  static const std::vector<StageKind> all{
      isotropic_kind(),      //
      compression_kind(),    //
      simple_shear_kind(),   //
      pressure_path_kind(),  //
      deviatoric_kind(),     //
      path_kind(),           //
      flow_kind(),           //
      deformation_kind(),    //
      envelope_kind(),       //
      relax_kind(),          //
      probe_kind(),          //
  };
  return all;
}

/// The kind of this name. std::logic_error if there is none.
const StageKind& kind_named(const std::string& name);

/// Names of the kinds whose stages events can end, or cannot, "a, b, c".
std::string kinds_with_events(bool taking);

}  // namespace rvelab::protocol
