// The simplex method of Nelder and Mead (1965): a minimum of a function of a few numbers, without derivatives.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace rvelab::fit {

/// From `start` with a first simplex of `size`; at most `most_calls` calls of the function, which must return a number
/// everywhere. Ends earlier when the values at the corners differ by less than `close`.
Eigen::VectorXd minimised(const std::function<double(const Eigen::VectorXd&)>& function, const Eigen::VectorXd& start,
                          double size = 0.5, int most_calls = 400, double close = 1e-3);

}  // namespace rvelab::fit
