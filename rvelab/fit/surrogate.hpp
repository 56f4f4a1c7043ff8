// A Gaussian process in place of tests: the mean of one measured quantity as a function of the parameters, learned from
// tests that scatter (Rasmussen and Williams 2006; Kennedy and O'Hagan 2001).
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

namespace rvelab::fit {

/// Mean and variance of what a surrogate says, at each of many points.
struct Prediction {
  Eigen::VectorXd mean, variance;
};

/// value = linear trend + Gaussian process of Matern 5/2 correlation + effect of the specimen + scatter of a test.
/// Points lie in the unit cube. The effect of a specimen is the same in all tests on it (common random specimens).
/// Correlation lengths and the three variances maximise the restricted likelihood with wide log-normal priors; the
/// trend is integrated over. Same input, same bits.
class Surrogate {
 public:
  /// One row of `points`, one specimen and one value for each test; more tests than parameters + 2. `before`: the
  /// hyperparameters of a surrogate of fewer of these tests, from which the search for the new ones starts.
  Surrogate(const Eigen::MatrixXd& points, const std::vector<std::size_t>& specimens, const Eigen::VectorXd& values,
            const Eigen::VectorXd& before = {});

  /// Of the mean over all specimens that there could be, or over `of_specimens`, those of the tests among them: the
  /// variance is that of not knowing it better. Of one specimen alone the former is known only as well as the prior
  /// says how specimens scatter.
  Prediction at(const Eigen::MatrixXd& points, std::size_t of_specimens = 0) const;

  /// Logarithms of the lengths, then of the standard deviations of process, specimen and test over that of the values.
  const Eigen::VectorXd& hyperparameters() const { return hyperparameters_; }

  double scatter() const;  ///< standard deviation of one test about that mean, effect of the specimen included

 private:
  void prepare(const Eigen::VectorXd& logarithms);
  double cost(const Eigen::VectorXd& logarithms);
  Eigen::MatrixXd correlation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const;

  Eigen::MatrixXd points_, same_specimen_;
  std::vector<Eigen::MatrixXd> squares_;  ///< of the distances of the tests along each parameter
  Eigen::VectorXd hyperparameters_;
  Eigen::VectorXd values_;  ///< shifted and scaled to mean 0 and variance 1
  double shift_ = 0, scale_ = 1;
  Eigen::VectorXd lengths_;
  double process_ = 0, shared_ = 0, own_ = 0;  ///< variances of process, specimen and test, of the scaled values
  Eigen::LLT<Eigen::MatrixXd> factor_, information_;
  Eigen::MatrixXd solved_trend_;
  Eigen::VectorXd trend_, weights_;
  double misfit_ = 0;  ///< squares of what the trend leaves, over the covariance
};

}  // namespace rvelab::fit
