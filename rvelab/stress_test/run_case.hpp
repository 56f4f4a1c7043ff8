// One case in this process, and its answer as text for the process that started it.
#pragma once

#include <string>

#include "rvelab/stress_test/matrix.hpp"
#include "rvelab/stress_test/verdict.hpp"

namespace rvelab::stress_test {

/// Runs a case. Errors, refusals and a lack of memory become answers; crashes and endless loops are the caller's.
Answer run_case(const Case& one);

/// An answer as lines "key value", and the way back. Without a line "outcome" the text is no answer: the status says
/// so.
std::string written_answer(const Answer& answer);
Answer read_answer(const std::string& text);

}  // namespace rvelab::stress_test
