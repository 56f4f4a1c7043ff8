// What a host is warned of after a step.
#pragma once

#include "rvelab/pool/status.hpp"
#include "rvelab/solver/loading/report.hpp"

namespace rvelab::pool {

/// Whether a step that was made over dt (s) gets a warning, and that warning.
inline bool has_warning(const Report& report, double dt) {
  return !report.target_held || report.cell_thin || (dt == 0 && (!report.quasi_static || !report.tolerance_met));
}
Verdict warning_of(const Report& report, double dt);

}  // namespace rvelab::pool
