// The verdict of a trial, and its tangent.
#pragma once

#include <array>

#include "rvelab/pool/pool.hpp"

namespace rvelab::pool {

/// Row-major, xx yy zz yz xz xy whatever the dimension.
using Tangent = std::array<double, 36>;

/// Of the exception that is being handled.
Verdict verdict_of_failure() noexcept;
/// Whether a trial that was made gets a warning, and that warning.
inline bool has_warning(const Report& report, double dt) {
  return report.cell_thin || (dt == 0 && (!report.quasi_static || !report.tolerance_met));
}
Verdict warning_of(const Report& report, double dt);
/// RVELAB_W_TANGENT_AFFINE: a warning that stands already keeps its place, and its text is extended.
void add_affine_warning(Verdict& verdict);
/// Writes the elastic tangent, or, where the network has none, the affine one and returns false.
bool write_tangent(const Network& network, Tangent& tangent);

}  // namespace rvelab::pool
