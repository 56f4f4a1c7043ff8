// The grid of a study: which keys are varied over which values, and the protocol of each combination.
#pragma once

#include <string>
#include <vector>

#include "rvelab/protocol/protocol.hpp"

namespace rvelab::study {

/// A key of a protocol and the values that it takes, as text: TOML, or a word.
struct Variation {
  std::string key;
  std::vector<std::string> values;
};

/// "KEY=v1,v2,...". Commas in brackets, braces and quotation marks belong to a value. InputError: no key, an empty list
/// or value, a value twice.
Variation parsed_variation(const std::string& text);

/// The number of combinations. InputError beyond `most_points`.
std::size_t points_in(const std::vector<Variation>& grid);
inline constexpr std::size_t most_points = 10'000;

/// The values of one combination, one for each variation; the last variation turns fastest. Points count from 0.
std::vector<std::string> values_at(const std::vector<Variation>& grid, std::size_t point);

/// "KEY=value" for each variation.
std::vector<std::string> assignments_at(const std::vector<Variation>& grid, std::size_t point);

/// What messages call a point: "KEY=value, KEY=value"; "the protocol as it is" without a variation.
std::string name_of(const std::vector<std::string>& assignments);

/// The protocol with `settings` and then `assignments`, each of which stands for one word `flag` of the command line.
/// InputError with the point's name in front, naming `flag` where the mistake is in an assignment.
protocol::Protocol protocol_with(const std::string& text, const std::string& path,
                                 const std::vector<std::string>& settings, const std::vector<std::string>& assignments,
                                 const std::string& flag);

}  // namespace rvelab::study
