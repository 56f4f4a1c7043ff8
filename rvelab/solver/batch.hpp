// Many RVEs over the cores: one increment for each, as a continuum code asks for at every step.
#pragma once

#include <exception>
#include <span>
#include <vector>

#include "rvelab/solver/rve.hpp"
#include "rvelab/threads/workers.hpp"

namespace rvelab {

/// What became of one RVE of a batch.
struct BatchEntry {
  Response response;           ///< of apply(); only if it did not fail
  std::exception_ptr failure;  ///< InvalidIncrement or IncrementFailed; that RVE is then exactly as it was
};

/// Applies displacement_gradients[k] (laboratory frame) to rves[k] over the time dt (s, 0: quasi-static). The same bits
/// whatever the number of workers; a failure concerns its own RVE only. InputError if the lengths differ.
std::vector<BatchEntry> apply_to_all(std::span<Rve> rves, std::span<const Matrix3> displacement_gradients, double dt,
                                     Workers& workers, const Want& want = {});

}  // namespace rvelab
