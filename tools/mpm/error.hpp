// Errors that the user can correct, and numbers in messages, as rvelab has them.
#pragma once

#include <vector>

#include "rvelab/error.hpp"

namespace mpm {

using rvelab::in_words;
using rvelab::InputError;

inline std::string in_words(const std::vector<double>& values) {
  std::string list;
  for (const double value : values) list += (list.empty() ? "[" : ", ") + in_words(value);
  return list + "]";
}

}  // namespace mpm
