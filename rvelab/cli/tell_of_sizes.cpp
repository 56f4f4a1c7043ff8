#include "rvelab/cli/tell_of_sizes.hpp"

#include "rvelab/error.hpp"

namespace rvelab::cli {

void tell_of_sizes(const Sizes& sizes) {
  constexpr double boulder = 0.5;  // m
  if (!(sizes.mean_diameter > boulder) || sizes.pressure != 0) return;
  tell("the mean diameter is " + in_words(sizes.mean_diameter) +
       " m, and no grains press each other: if millimetres were meant, multiply coordinates, radii and cell by 1e-3");
}

}  // namespace rvelab::cli
