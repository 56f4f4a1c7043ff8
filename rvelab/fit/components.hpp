// Targets as independent components: the points of a curve go together, so that each curve is described by the few
// principal components in which the tests differ.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rvelab/fit/search.hpp"

namespace rvelab::fit {

class Components {
 public:
  /// `values`: one row a test, one column a target. A curve gets the components that hold 99 % of the variance of its
  /// points over all tests, at most `parameters` + 2. Points are scaled by deviation of the tests and standard error,
  /// sqrt(d^2 + e^2), so that one that was measured worse than the tests differ weighs little.
  Components(const std::vector<Target>& targets, const Eigen::MatrixXd& values, Eigen::Index parameters);

  Eigen::MatrixXd of(const Eigen::MatrixXd& values) const;    ///< one column a component
  Eigen::MatrixXd back(const Eigen::MatrixXd& scores) const;  ///< one column a target, without what was left out
  const Eigen::VectorXd& target() const { return target_; }
  /// Standard errors. Of a curve: as if the errors of all its points were the largest together, unless Target::common
  /// says which part they share.
  const Eigen::VectorXd& error() const { return error_; }

 private:
  Eigen::MatrixXd directions_;  ///< one column a component; orthonormal in the scaled targets
  Eigen::VectorXd shift_, scale_, target_, error_;
};

}  // namespace rvelab::fit
