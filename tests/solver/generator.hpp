// Random numbers for drawn grains.
#pragma once

#include <random>

namespace rvelab::test {

using Generator = std::mt19937_64;

inline double uniform(Generator& generator, double low, double high) {
  return low + (high - low) * (double(generator() >> 11) / 9007199254740992.0);
}

}  // namespace rvelab::test
