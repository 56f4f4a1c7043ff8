#include "rvelab/pool/warnings.hpp"

#include <cstdio>

#include "rvelab/solver/quasi_static/constants.hpp"

namespace rvelab::pool {

Status write_warning(const Report& report, double dt, char* text, std::size_t size) noexcept {
  Status status = Status::cell_thin;
  if (!report.target_held) {
    status = Status::not_held;
    std::snprintf(text, size,
                  "a stress of the mixed target was missed by %g of its scale: take smaller steps, a longer time, or a "
                  "wider tolerance",
                  report.held_error);
  } else if (!report.in_equilibrium && loading_of(dt) == Loading::quasi_static) {
    status = Status::not_quasi_static;
    std::snprintf(text, size,
                  "the state is no equilibrium: the unbalanced ratio is %g; the specimen flows or collapses: take "
                  "smaller steps, or give a time (dt > 0)",
                  report.unbalanced_ratio);
  } else if (loading_of(dt) == Loading::quasi_static && !report.tolerance_met) {
    status = Status::tolerance_missed;
    std::snprintf(text, size,
                  "the stress has an expected error of %g Pa; the tolerance allows %g Pa: take it as it is, or widen "
                  "tolerance_rel or tolerance_abs",
                  report.error_estimate / constants::met_margin, report.allowed_error);
  } else {
    std::snprintf(text, size,
                  "a height of the cell is below four mean diameters: it stands for less and less of the material; "
                  "use a larger specimen");
  }
  return status;
}

Verdict warning_of(const Report& report, double dt) {
  char text[320];
  const Status status = write_warning(report, dt, text, sizeof text);
  return {status, text};
}

}  // namespace rvelab::pool
