// Inputs made from others by small damage, the same on every machine: a seed of random numbers gives an input.
#pragma once

#include <random>

#include "tests/fuzz/formats.hpp"

namespace rvelab::fuzz {

/// One of the seeds with one to eight changes: bits, bytes, cuts, splices with another seed; in text lines too, numbers
/// at the edge of their range, words exchanged.
Bytes mutated(const std::vector<Bytes>& seeds, bool is_text, std::mt19937_64& random);

/// One more change.
void change(Bytes& input, const std::vector<Bytes>& seeds, bool is_text, std::mt19937_64& random);

}  // namespace rvelab::fuzz
