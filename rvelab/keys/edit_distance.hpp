// How far one word is from another, for the nearest known name of a misspelt one.
#pragma once

#include <cstddef>
#include <string>

namespace rvelab::keys {

/// Edit distance times four; letters that the candidate goes on with, such as a unit left out, count one each.
std::size_t edit_distance(const std::string& word, const std::string& candidate);

}  // namespace rvelab::keys
