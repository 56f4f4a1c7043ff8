// What a host is warned of after a step.
#pragma once

#include <cstddef>

#include "rvelab/pool/status.hpp"
#include "rvelab/solver/loading/report.hpp"

namespace rvelab::pool {

/// Whether a step that was made over dt (s) gets a warning, and that warning.
inline bool has_warning(const Report& report, double dt) {
  return !report.target_held || report.cell_thin || (dt == 0 && (!report.quasi_static || !report.tolerance_met));
}
Verdict warning_of(const Report& report, double dt);
/// The same with its text cut to `size` bytes, without memory of its own.
Status write_warning(const Report& report, double dt, char* text, std::size_t size) noexcept;

}  // namespace rvelab::pool
