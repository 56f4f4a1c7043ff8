// A specimen by the C interface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/voids/power_cells.hpp"

namespace rvelab::voids {

/// Discs or spheres of a specimen file, or of a record file: its end state.
struct PackedGrains {
  PeriodicCell cell;
  Matrix3 rotation;  ///< cell frame to laboratory
  std::vector<std::int64_t> id;
  std::vector<Ball> balls;  ///< cell frame
};

/// InputError: no such file, or grains other than discs or spheres; Error: any other failure.
PackedGrains read_grains(const std::string& file);

}  // namespace rvelab::voids
