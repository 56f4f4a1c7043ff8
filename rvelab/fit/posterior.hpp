// What the targets say of the parameters: a sample of their posterior distribution.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>

namespace rvelab::fit {

/// Logarithm of the likelihood at each row of points in the unit cube.
using LogLikelihood = std::function<Eigen::VectorXd(const Eigen::MatrixXd&)>;

/// The first points of Halton's sequence (1960), a row each; bases are the first primes, at most eight dimensions.
Eigen::MatrixXd halton(Eigen::Index count, Eigen::Index dimensions);

/// `count` points from likelihood times a uniform prior over the unit cube: importance sampling whose temperature falls
/// in steps that keep half of the sample effective, with Metropolis moves after each (Del Moral, Doucet and Jasra
/// 2006). Same seed, same bits.
Eigen::MatrixXd sampled(const LogLikelihood& log_likelihood, Eigen::Index dimensions, Eigen::Index count,
                        std::uint64_t seed);

/// The value below which a share of the numbers lies, linear between them; NaN of none.
double quantile(Eigen::VectorXd values, double share);

}  // namespace rvelab::fit
