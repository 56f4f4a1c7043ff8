// The matrix of cases, as a TOML file: which experiment with which numbers, what is asked, by which source, within
// which limits. Read and checked whole before anything runs.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace rvelab::stress_test {

/// One case. A table [[case]] with `vary` gives several.
struct Case {
  std::string name;        ///< "stiffness/linear/kappa=1e4"
  std::string experiment;  ///< one of the list in experiments.hpp
  std::string asked;       ///< in words
  std::string invariant;   ///< what is compared with what
  std::string source;      ///< paper, formula, or "definition"
  double tolerance = 0;    ///< of the invariant; the experiment says of what
  bool quick = false;
  bool may_refuse = false;  ///< a clean refusal is an answer too
  bool may_flag = false;    ///< a flag of the solver excuses a result that does not agree
  double seconds = 0;       ///< processor time allowed
  double memory_MiB = 0;
  std::map<std::string, double> parameters;  ///< every parameter of the experiment, defaults filled in
  double operator()(const std::string& parameter) const { return parameters.at(parameter); }
};

/// Reads a matrix file. InputError with every mistake and its line: unknown keys, experiments and parameters (with the
/// nearest known name), values of another type, limits out of range, names that come twice.
std::vector<Case> read_matrix(const std::string& path);

/// A number as names show it: "0.05", "1e4", "-3e-7".
std::string written_number(double value);

}  // namespace rvelab::stress_test
