// Mixed targets of RVEs in a pool: one call as plain numbers, so that it can travel to the process that holds the RVE,
// and many of them by one call of a host.
#pragma once

#include <cstdint>
#include <functional>

#include "rvelab/pool/pool.hpp"

namespace rvelab::pool {

/// Tensors row-major, as in rvelab_mixed.
struct MixedRow {
  double strain[9], stress[9], value, scale, missed;
};
struct MixedSetting {
  double dt, tolerance, spin[9];
};
struct MixedDone {
  double sigma[9], displacement_gradient[9], held_error, error_estimate;
  std::int64_t token;
  std::int64_t status;  ///< Status
  char text[320];       ///< of a warning
};
struct RelaxDone {
  double sigma[9], unbalanced;
  std::int64_t substeps, reached;
};

/// call(m, verdict) for each entry of a call `name` on count >= 0 RVEs, shared out among the threads; what it throws
/// becomes its verdict. Status of each, unless null. The worst verdict, whose text names index and id. Refused
/// (duplicate) before any work.
Verdict each_entry(Pool& pool, const char* name, std::int64_t count, const std::int64_t* ids, std::int32_t* status,
                   const std::function<void(std::size_t, Verdict&)>& call);

/// Applies each entry; the worst status, whose text names index and id.
Verdict apply_mixed(Pool& pool, const rvelab_mixed& batch);

}  // namespace rvelab::pool
