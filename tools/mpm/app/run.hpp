// A run: steps, histories, frames, checkpoints, and where the time went. Its folder holds
//
//   scene.toml          the scene with its cases and assignments
//   history.csv         energies, momentum and reactions over time
//   watched.csv         chosen points over time
//   points_NNNN.h5      all points of a frame; points.xdmf shows them to ParaView
//   network_K_NNNN.h5   on demand: the RVE of watched point K at that frame
//   checkpoint.h5       what --resume goes on from, with one file of RVEs for each material of grains
#pragma once

#include <iosfwd>
#include <string>

#include "tools/mpm/materials/grains.hpp"
#include "tools/mpm/scene/scene.hpp"

namespace mpm {

struct RunOptions {
  std::string folder;
  std::string specimens = ".";
  int threads = 0;  ///< 0: as many as the processor runs at once
  bool resume = false;
  bool quiet = false;  ///< no progress line
  PoolSource source;
  double stop_at = 1e300;  ///< s; writes a checkpoint there and ends
  /// Resumed with another scene than the folder's: what scene.toml becomes once the run goes on. "": it stays.
  std::string scene_text;
};

/// Exit code: 0 done, or stopped where it was asked to, 130 interrupted with a checkpoint. `report` gets what the run
/// cost.
int run_scene(const Scene& scene, const RunOptions& options, std::ostream& report);

}  // namespace mpm
