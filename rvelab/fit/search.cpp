#include "rvelab/fit/search.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/error.hpp"
#include "rvelab/fit/components.hpp"
#include "rvelab/fit/posterior.hpp"
#include "rvelab/fit/surrogate.hpp"

namespace rvelab::fit {
namespace {

/// Tests that could be carried out, as matrices.
struct Learned {
  Eigen::MatrixXd points, values;
  std::vector<std::size_t> specimens;
};

Learned learned_from(const Problem& problem, const Finding& so_far) {
  std::vector<std::size_t> good;
  for (std::size_t k = 0; k < so_far.answers.size(); ++k) {
    const Answer& answer = so_far.answers[k];
    const bool whole = answer.size() == problem.targets.size() &&
                       std::all_of(answer.begin(), answer.end(), [](double value) { return std::isfinite(value); });
    if (whole) good.push_back(k);
  }
  const std::size_t least = std::size_t(problem.parameters) + 4;
  if (good.size() < least)
    throw Error("fit: " + std::to_string(good.size()) + " of " + std::to_string(so_far.answers.size()) +
                " tests gave every target; at least " + std::to_string(least) + " are needed" +
                most_often_missing(problem.targets, so_far.answers) +
                "; narrow the ranges of --vary, or spend more tests");
  Learned learned{Eigen::MatrixXd(Eigen::Index(good.size()), problem.parameters),
                  Eigen::MatrixXd(Eigen::Index(good.size()), Eigen::Index(problem.targets.size())),
                  {}};
  for (std::size_t row = 0; row < good.size(); ++row) {
    learned.points.row(Eigen::Index(row)) = so_far.candidates[good[row]].point.transpose();
    for (std::size_t k = 0; k < problem.targets.size(); ++k)
      learned.values(Eigen::Index(row), Eigen::Index(k)) = so_far.answers[good[row]][k];
    learned.specimens.push_back(so_far.candidates[good[row]].specimen);
  }
  return learned;
}

/// A surrogate for each component of the targets, and the likelihood of these.
class Judge {
 public:
  /// `before`: hyperparameters of each surrogate of a judge of fewer tests; brought up to those of this one.
  Judge(const Problem& problem, const Learned& learned, std::vector<Eigen::VectorXd>& before)
      : components_(problem.targets, learned.values, problem.parameters) {
    const Eigen::MatrixXd scores = components_.of(learned.values);
    const std::set<std::size_t> specimens(learned.specimens.begin(), learned.specimens.end());
    constexpr double of_many = 1.96;
    if (problem.same_specimens)
      of_specimens_ = problem.specimens;
    else if (specimens.size() > 1)
      student_ = ensemble::students_t(double(specimens.size() - 1)) / of_many;
    before.resize(std::size_t(scores.cols()));
    for (Eigen::Index k = 0; k < scores.cols(); ++k) {
      Eigen::VectorXd& hyperparameters = before[std::size_t(k)];
      surrogates_.emplace_back(learned.points, learned.specimens, scores.col(k), hyperparameters);
      hyperparameters = surrogates_.back().hyperparameters();
    }
  }

  Eigen::VectorXd log_likelihood(const Eigen::MatrixXd& points, double power, double widening) const {
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(points.rows());
    for (std::size_t k = 0; k < surrogates_.size(); ++k) {
      const Prediction found = surrogates_[k].at(points, of_specimens_);
      const Eigen::ArrayXd variance = widening * widening * variance_of(k, found);
      sum -= 0.5 * (off(k, found).square() / variance + variance.log());
    }
    return power * sum;
  }

  /// Sum of the squared errors over their variances, at each point.
  Eigen::VectorXd squares(const Eigen::MatrixXd& points) const {
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(points.rows());
    for (std::size_t k = 0; k < surrogates_.size(); ++k) {
      const Prediction found = surrogates_[k].at(points, of_specimens_);
      sum += off(k, found).square() / variance_of(k, found);
    }
    return sum;
  }

  /// Means of all targets at the points.
  Eigen::MatrixXd predicted(const Eigen::MatrixXd& points) const {
    Eigen::MatrixXd scores(points.rows(), Eigen::Index(surrogates_.size()));
    for (std::size_t k = 0; k < surrogates_.size(); ++k)
      scores.col(Eigen::Index(k)) = surrogates_[k].at(points, of_specimens_).mean;
    return components_.back(scores);
  }

  Eigen::Index count() const { return Eigen::Index(surrogates_.size()); }

 private:
  Eigen::ArrayXd off(std::size_t k, const Prediction& found) const {
    return found.mean.array() - components_.target()[Eigen::Index(k)];
  }
  Eigen::ArrayXd variance_of(std::size_t k, const Prediction& found) const {
    const double error = components_.error()[Eigen::Index(k)], floor = 1e-3 * surrogates_[k].scatter();
    return student_ * student_ * found.variance.array() + (error * error + floor * floor + 1e-300);
  }

  Components components_;
  std::vector<Surrogate> surrogates_;
  std::size_t of_specimens_ = 0;  ///< whose mean was measured; 0: of all that there could be
  double student_ = 1;  ///< Student's t of the specimens over that of infinitely many: few tell their scatter badly
};

/// Adds the trials of one batch and what they give.
void run_batch(const Problem& problem, const RunCandidates& run, const Eigen::MatrixXd& points, Finding& so_far) {
  std::vector<Candidate> batch;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const std::size_t number = so_far.candidates.size() + std::size_t(k);
    batch.push_back({number, points.row(k).transpose(), number % problem.specimens});
  }
  const std::vector<Answer> answers = run(batch);
  so_far.candidates.insert(so_far.candidates.end(), batch.begin(), batch.end());
  so_far.answers.insert(so_far.answers.end(), answers.begin(), answers.end());
}

}  // namespace

std::string most_often_missing(const std::vector<Target>& targets, const std::vector<Answer>& answers) {
  std::pair<std::size_t, std::size_t> most{0, 0};
  for (std::size_t k = 0; k < targets.size(); ++k) {
    std::size_t missing = 0;
    for (const Answer& answer : answers)
      if (answer.size() == targets.size() && !std::isfinite(answer[k])) ++missing;
    if (missing > most.first) most = {missing, k};
  }
  if (most.first == 0) return "";
  return "; " + targets[most.second].name + " is missing in " + std::to_string(most.first);
}

std::size_t usual_tests(Eigen::Index parameters) { return std::size_t(24 + 16 * parameters); }
std::size_t usual_tests_of_features(Eigen::Index parameters) { return std::size_t(24 + 8 * parameters); }

Finding search(const Problem& problem, const RunCandidates& run) {
  Finding found;
  const std::size_t first =
      std::min<std::size_t>(problem.tests, std::size_t(std::max<Eigen::Index>(8, 5 * problem.parameters)));
  run_batch(problem, run, halton(Eigen::Index(first), problem.parameters), found);
  std::vector<Eigen::VectorXd> hyperparameters;
  while (found.candidates.size() < problem.tests) {
    const Judge judge(problem, learned_from(problem, found), hyperparameters);
    // Half of the likelihood's logarithm: wider than the posterior, so that its flanks are learned too.
    const Eigen::MatrixXd likely =
        sampled([&](const Eigen::MatrixXd& points) { return judge.log_likelihood(points, 0.5, 1); }, problem.parameters,
                200, found.candidates.size());
    const std::size_t count = std::min(problem.batch, problem.tests - found.candidates.size());
    Eigen::MatrixXd next(Eigen::Index(count), problem.parameters);
    for (std::size_t k = 0; k < count; ++k)
      next.row(Eigen::Index(k)) = likely.row(Eigen::Index(k) * likely.rows() / Eigen::Index(count));
    run_batch(problem, run, next, found);
  }
  const Judge judge(problem, learned_from(problem, found), hyperparameters);
  const auto sample = [&](double widening) {
    return sampled([&](const Eigen::MatrixXd& points) { return judge.log_likelihood(points, 1, widening); },
                   problem.parameters, problem.sample, found.candidates.size());
  };
  found.sample = sample(1);
  const double least = judge.squares(found.sample).minCoeff();
  found.misfit = std::sqrt(least / double(judge.count()));
  // Birge (1932): errors that are too small for the scatter of the targets about the best fit are widened.
  const double freedom = double(judge.count() - problem.parameters);
  found.widening = freedom > 0 ? std::sqrt(std::max(1.0, least / freedom)) : 1;
  if (found.widening > 1) found.sample = sample(found.widening);
  found.predicted = judge.predicted(found.sample);
  return found;
}

}  // namespace rvelab::fit
