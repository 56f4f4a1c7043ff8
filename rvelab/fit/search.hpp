// The search for parameters whose tests give what was measured.
//
// Tests scatter, so each is one observation of the surrogates (surrogate.hpp); the search makes tests where the
// parameters are likely, and ends with a sample of their posterior. It knows no test and no file: `run` makes them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace rvelab::fit {

/// A quantity that the tests give and that was measured.
struct Target {
  std::string name;
  double value = 0;
  double error = 0;  ///< standard error of the value; 0: exact
  int curve = -1;    ///< targets of one number >= 0 are points of one curve, whose errors go together
  /// Of such a group: part of the variance of their errors that all share, the rest is independent; none: all errors
  /// may be the largest together, in whatever direction.
  std::optional<double> common{};
};

struct Problem {
  Eigen::Index parameters = 0;
  std::vector<Target> targets;
  std::size_t specimens = 1;
  bool same_specimens = false;  ///< the targets were measured on these specimens (their mean), not on others of a kind
  std::size_t tests = 0;        ///< to spend
  std::size_t batch = 8;        ///< tests at a time, whatever the number of threads
  Eigen::Index sample = 1000;   ///< points of the posterior sample
};

/// A candidate: its point in the unit cube of the parameters, and its specimen.
struct Candidate {
  std::size_t number = 0;  ///< from 0
  Eigen::VectorXd point;
  std::size_t specimen = 0;
};

/// What it gave, in the order of the targets; empty: it could not be carried out.
using Answer = std::vector<double>;

using RunCandidates = std::function<std::vector<Answer>(const std::vector<Candidate>&)>;

struct Finding {
  std::vector<Candidate> candidates;
  std::vector<Answer> answers;
  Eigen::MatrixXd sample;     ///< points of the posterior, one a row
  Eigen::MatrixXd predicted;  ///< mean of the tests at each of them, one column a target
  double misfit = 0;          ///< root of the mean squared error of the best point over its standard deviation; above
                              ///< about 2 no parameters in their ranges give the targets
  double widening = 1;        ///< of the standard errors, where the targets contradict each other
};

/// Spends the tests and samples the posterior, of a prior that is uniform over the unit cube. Same problem and answers,
/// same bits. Error if so many tests fail that too few are left.
Finding search(const Problem& problem, const RunCandidates& run);

/// "; NAME is missing in 7": the target that tests which were carried out lack most often; "" if none does.
std::string most_often_missing(const std::vector<Target>& targets, const std::vector<Answer>& answers);

/// Tests that are spent without another number: 24 and 16 for each parameter.
std::size_t usual_tests(Eigen::Index parameters);
/// Where features alone are fitted: 24 and 8 for each. Of ten sands of five parameters 9, 10, 10 lay in their intervals
/// with 48, 64, 104 tests, whose mean width was 0.67 of the range with each (tests/fit/test_features.cpp).
std::size_t usual_tests_of_features(Eigen::Index parameters);

}  // namespace rvelab::fit
