// The Pareto front of runs: those that no other run beats at once in what they cost and in how far they are off.
#pragma once

#include <vector>

namespace rvelab::study {

struct Standing {
  double cost = 0, error = 0;
};

/// True for each standing that is on the front: no other one is at most as dear and at most as far off, and better in
/// one of the two. Equal ones are all on it. One that is not finite is not on it and beats nothing.
std::vector<bool> pareto_front(const std::vector<Standing>& standings);

}  // namespace rvelab::study
