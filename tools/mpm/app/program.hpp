// rvelab-mpm: a scene in TOML is run, or a run is resumed.
#pragma once

#include "tools/mpm/materials/grains.hpp"

namespace mpm {

/// The exit code: 0 done, or stopped where --stop-at says, 130 interrupted with a checkpoint, 1 failed, 2 an error in
/// the input.
int program(int argc, char** argv, const PoolSource& source);

}  // namespace mpm
