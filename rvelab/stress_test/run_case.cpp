#include "rvelab/stress_test/run_case.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <sstream>

#include "rvelab/stress_test/experiments.hpp"

namespace rvelab::stress_test {

namespace {

/// Longer texts would only fill the table.
constexpr std::size_t longest_status = 600;

Answer failed(const std::string& status) {
  Answer answer;
  answer.status = status;
  return answer;
}

}  // namespace

Answer run_case(const Case& one) {
  Verdict verdict;
  try {
    for (const Experiment& experiment : experiments()) {
      if (experiment.name != one.experiment) continue;
      experiment.run(one, verdict);
      return verdict.answer(one.may_flag);
    }
    return failed("there is no experiment " + one.experiment);
  } catch (const Refused& refusal) {
    return verdict.answer(refusal, one.may_refuse);
  } catch (const std::bad_alloc&) {
    return failed("memory limit");
  } catch (const std::exception& error) {
    return failed(std::string("the experiment could not be made: ") + error.what());
  }
}

std::string written_answer(const Answer& answer) {
  std::string text = std::string("outcome ") + name(answer.outcome) + "\n";
  char number[64];
  if (answer.error) {
    std::snprintf(number, sizeof number, "error %.17g\n", *answer.error);
    text += number;
  }
  if (answer.hash) {
    std::snprintf(number, sizeof number, "hash %llx\n", static_cast<unsigned long long>(*answer.hash));
    text += number;
  }
  std::string status = answer.status.substr(0, longest_status);
  for (char& c : status)
    if (c == '\n') c = ' ';
  return text + "status " + status + "\n";
}

Answer read_answer(const std::string& text) {
  Answer answer = failed("no answer");
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto space = line.find(' ');
    if (space == std::string::npos) continue;
    const std::string key = line.substr(0, space), value = line.substr(space + 1);
    if (key == "outcome")
      for (const Outcome outcome : {Outcome::right, Outcome::refused, Outcome::wrong})
        if (value == name(outcome)) answer.outcome = outcome;
    if (key == "error") answer.error = std::strtod(value.c_str(), nullptr);
    if (key == "hash") answer.hash = std::strtoull(value.c_str(), nullptr, 16);
    if (key == "status") answer.status = value;
  }
  return answer;
}

}  // namespace rvelab::stress_test
