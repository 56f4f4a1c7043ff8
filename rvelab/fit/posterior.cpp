#include "rvelab/fit/posterior.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "rvelab/grains/uniform.hpp"

namespace rvelab::fit {
namespace {

/// Standard normal numbers (Box and Muller 1958).
double normal(Uniform& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random()));
  return radius * std::cos(2 * std::numbers::pi * random());
}

/// Weights of a step of the temperature, adding up to 1.
Eigen::ArrayXd weights_of(double step, const Eigen::VectorXd& logarithms) {
  const Eigen::ArrayXd weights = (step * (logarithms.array() - logarithms.maxCoeff())).exp();
  return weights / weights.sum();
}

/// The largest step up to `most` that leaves half of the sample effective.
double step_of(double most, const Eigen::VectorXd& logarithms) {
  const double half = 0.5 * double(logarithms.size());
  double step = most;
  while (step > 1e-6 && 1 / weights_of(step, logarithms).square().sum() < half) step *= 0.7;
  return step;
}

/// Draws the rows anew by their weights, evenly spaced in the sum of the weights.
void draw_anew(Eigen::MatrixXd& points, Eigen::VectorXd& logarithms, const Eigen::ArrayXd& weights, double shift) {
  const Eigen::MatrixXd old_points = points;
  const Eigen::VectorXd old_logarithms = logarithms;
  const Eigen::Index count = points.rows();
  Eigen::Index from = 0;
  double sum = weights[0];
  for (Eigen::Index k = 0; k < count; ++k) {
    while (sum < (double(k) + shift) / double(count) && from + 1 < count) sum += weights[++from];
    points.row(k) = old_points.row(from);
    logarithms[k] = old_logarithms[from];
  }
}

/// Factor of the covariance of the rows.
Eigen::MatrixXd spread_of(const Eigen::MatrixXd& points) {
  const Eigen::MatrixXd centred = points.rowwise() - points.colwise().mean();
  Eigen::MatrixXd covariance = centred.transpose() * centred / double(points.rows() - 1);
  covariance.diagonal().array() += 1e-10;
  return covariance.llt().matrixL();
}

}  // namespace

Eigen::MatrixXd halton(Eigen::Index count, Eigen::Index dimensions) {
  constexpr int primes[] = {2, 3, 5, 7, 11, 13, 17, 19};
  Eigen::MatrixXd points(count, dimensions);
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index j = 0; j < dimensions; ++j) {
      double part = 1;
      points(k, j) = 0;
      for (Eigen::Index rest = k + 1; rest > 0; rest /= primes[j]) {
        part /= primes[j];
        points(k, j) += part * double(rest % primes[j]);
      }
    }
  }
  return points;
}

Eigen::MatrixXd sampled(const LogLikelihood& log_likelihood, Eigen::Index dimensions, Eigen::Index count,
                        std::uint64_t seed) {
  constexpr int moves = 6;
  Uniform random(seed);
  Eigen::MatrixXd points = halton(count, dimensions);
  Eigen::VectorXd logarithms = log_likelihood(points);
  const double length = 2.38 / std::sqrt(double(dimensions));  // Roberts, Gelman and Gilks 1997
  for (double reached = 0; reached < 1;) {
    const double step = step_of(1 - reached, logarithms);
    draw_anew(points, logarithms, weights_of(step, logarithms), random());
    reached = reached + step > 1 - 1e-9 ? 1 : reached + step;
    const Eigen::MatrixXd spread = spread_of(points);
    for (int move = 0; move < moves; ++move) {
      Eigen::MatrixXd steps(count, dimensions);
      for (Eigen::Index k = 0; k < count; ++k)
        for (Eigen::Index j = 0; j < dimensions; ++j) steps(k, j) = normal(random);
      const Eigen::MatrixXd trial = points + length * std::pow(0.5, move % 3) * steps * spread.transpose();
      const Eigen::VectorXd there = log_likelihood(trial.cwiseMax(0).cwiseMin(1));
      for (Eigen::Index k = 0; k < count; ++k) {
        const bool inside = (trial.row(k).array() >= 0).all() && (trial.row(k).array() <= 1).all();
        const double chance = random();
        if (!inside || std::log(1 - chance) >= reached * (there[k] - logarithms[k])) continue;
        points.row(k) = trial.row(k);
        logarithms[k] = there[k];
      }
    }
  }
  return points;
}

double quantile(Eigen::VectorXd values, double share) {
  if (values.size() == 0) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double point = share * double(values.size() - 1);
  const auto below = std::min(static_cast<Eigen::Index>(point), values.size() - 1);
  const Eigen::Index above = std::min(below + 1, values.size() - 1);
  return values[below] + (point - double(below)) * (values[above] - values[below]);
}

}  // namespace rvelab::fit
