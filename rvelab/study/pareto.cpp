#include "rvelab/study/pareto.hpp"

#include <algorithm>
#include <cmath>

namespace rvelab::study {

std::vector<bool> pareto_front(const std::vector<Standing>& standings) {
  const auto finite = [](const Standing& one) { return std::isfinite(one.cost) && std::isfinite(one.error); };
  std::vector<bool> front;
  for (const Standing& one : standings) {
    const bool beaten = std::any_of(standings.begin(), standings.end(), [&](const Standing& other) {
      return finite(other) && other.cost <= one.cost && other.error <= one.error &&
             (other.cost < one.cost || other.error < one.error);
    });
    front.push_back(finite(one) && !beaten);
  }
  return front;
}

}  // namespace rvelab::study
