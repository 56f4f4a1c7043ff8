// What a host is warned of after a step.
#pragma once

#include <cstddef>

#include "rvelab/pool/status.hpp"
#include "rvelab/solver/loading/loading_state.hpp"
#include "rvelab/solver/loading/report.hpp"

namespace rvelab::pool {

/// Whether a step that was made over dt (s) gets a warning, and that warning.
inline bool has_warning(const Report& report, double dt) {
  const bool judged = loading_of(dt) == Loading::quasi_static;
  return !report.target_held || report.cell_thin || (judged && (!report.in_equilibrium || !report.tolerance_met));
}
Verdict warning_of(const Report& report, double dt);
/// The same with its text cut to `size` bytes, without memory of its own.
Status write_warning(const Report& report, double dt, char* text, std::size_t size) noexcept;

}  // namespace rvelab::pool
