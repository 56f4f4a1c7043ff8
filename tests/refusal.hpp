// What is refused, as the message that the user reads.
#pragma once

#include <string>

#include "rvelab/error.hpp"

namespace rvelab::test {

/// The message of the error of this kind that a call throws; "" if it throws none.
template <class Kind, class Call>
std::string error_text(Call call) {
  try {
    call();
  } catch (const Kind& error) {
    return error.what();
  }
  return "";
}

template <class Call>
std::string input_error(Call call) {
  return error_text<InputError>(call);
}

}  // namespace rvelab::test
