// The Pareto front of runs: no other run has both a lower cost and a lower error.
#pragma once

#include <vector>

namespace rvelab::study {

struct Standing {
  double cost = 0, error = 0;
};

/// True for each standing on the front: no other one has at most its cost and at most its error, and less of one. Equal
/// ones are all on it. Standings that are not finite are ignored.
std::vector<bool> pareto_front(const std::vector<Standing>& standings);

}  // namespace rvelab::study
