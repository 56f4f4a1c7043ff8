// The cases of matrix.toml, the experiments that they choose from, and what runs them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/extreme/verdict.hpp"

namespace rvelab::test {

struct Experiment;

/// One case. A row of matrix.toml with `vary` gives several.
struct Case {
  std::string name;  ///< "stiffness/kappa/kappa=1e4,shear=0"
  const Experiment* experiment = nullptr;
  std::string asked;                         ///< in words
  double tolerance = 0;                      ///< the experiment says of what
  bool quick = false;                        ///< a test of ctest
  bool may_refuse = false;                   ///< a clean refusal is an answer too
  bool may_flag = false;                     ///< a flag of the solver excuses a result that does not agree
  double seconds = 0;                        ///< processor time allowed
  double memory_MiB = 4096;                  ///< address space allowed
  std::map<std::string, double> parameters;  ///< every parameter of the experiment, defaults filled in
  double operator()(const std::string& parameter) const { return parameters.at(parameter); }
};

/// Parameters are pure numbers or SI, truths 0 and 1, with the values for cases that do not give one: "dimension 2,
/// hertz 0".
struct Experiment {
  std::string name;
  void (*run)(const Case&, Verdict&);
  std::string parameters;
};

// The experiments of each topic, in the file of its name.
std::vector<Experiment> stiffness_experiments();
std::vector<Experiment> statics_experiments();
std::vector<Experiment> size_experiments();
std::vector<Experiment> deformation_experiments();
std::vector<Experiment> increment_experiments();
std::vector<Experiment> rate_experiments();
std::vector<Experiment> impact_experiments();
std::vector<Experiment> gas_experiments();
std::vector<Experiment> number_experiments();

/// matrix.toml, or another file. Throws what is wrong with it.
std::vector<Case> read_matrix(const std::string& path = RVELAB_SOURCE_DIR "/tests/extreme/matrix.toml");

struct Result {
  const Case* asked = nullptr;
  Answer answer;
  double seconds = 0;  ///< processor time
};

/// All results, in the order of the cases. A process that crashes, hangs or runs out of memory is a result, WRONG.
std::vector<Result> run(const std::vector<Case>& cases, unsigned at_a_time = 1);

}  // namespace rvelab::test
