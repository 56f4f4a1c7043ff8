// The random numbers of everything that rvelab makes: own generator, so that every machine makes the same grains.
#pragma once

#include <cstdint>

namespace rvelab {

/// SplitMix64 (Steele, Lea and Flood 2014); calls give numbers in [0, 1), multiples of 2^-53.
class Uniform {
 public:
  /// The streams of one seed are independent of each other: a draw of its own for each.
  explicit Uniform(std::uint64_t seed, std::uint64_t stream = 0) : state_(seed) {
    if (stream > 0) state_ = next() ^ (stream * 0xd1342543de82ef95ULL);
  }
  double operator()() { return double(next() >> 11) * 0x1.0p-53; }

 private:
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace rvelab
