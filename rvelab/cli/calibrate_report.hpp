// What `rvelab calibrate` prints.
#pragma once

#include <string>
#include <vector>

#include "rvelab/calibrate/calibrate.hpp"

namespace rvelab::cli {

/// `protocol`: its name; `specimens`: their files.
void report_calibration(const calibrate::Calibration& calibration, const std::string& protocol,
                        const std::vector<std::string>& specimens, double wall_seconds, bool json);

}  // namespace rvelab::cli
