#include "rvelab/fit/surrogate.hpp"

#include <cmath>

#include "rvelab/fit/minimise.hpp"

namespace rvelab::fit {
namespace {

constexpr double usual_deviation = -1;  // logarithm of it, over that of the values

/// Constant and linear terms of the trend.
Eigen::MatrixXd trend_at(const Eigen::MatrixXd& points) {
  Eigen::MatrixXd terms(points.rows(), points.cols() + 1);
  terms << Eigen::VectorXd::Ones(points.rows()), points;
  return terms;
}

/// Matern 5/2 of squared distances, times 5, over the squared lengths.
Eigen::ArrayXXd matern(const Eigen::ArrayXXd& squares) {
  const Eigen::ArrayXXd r = squares.sqrt();
  return (1 + r + squares / 3) * (-r).exp();
}

}  // namespace

Surrogate::Surrogate(const Eigen::MatrixXd& points, const std::vector<std::size_t>& specimens,
                     const Eigen::VectorXd& values, const Eigen::VectorXd& before)
    : points_(points), same_specimen_(values.size(), values.size()) {
  const Eigen::Index count = values.size(), parameters = points.cols();
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      same_specimen_(i, j) = specimens[std::size_t(i)] == specimens[std::size_t(j)] ? 1 : 0;
  shift_ = values.mean();
  scale_ = std::sqrt((values.array() - shift_).square().mean());
  if (!(scale_ > 0)) scale_ = 1;
  values_ = (values.array() - shift_) / scale_;
  for (Eigen::Index j = 0; j < parameters; ++j) {
    const Eigen::MatrixXd rows = points.col(j).replicate(1, count);
    squares_.emplace_back((rows - rows.transpose()).array().square());
  }
  Eigen::VectorXd start = Eigen::VectorXd::Zero(parameters + 3);
  start.tail(3).setConstant(usual_deviation);
  const bool goes_on = before.size() == start.size();
  hyperparameters_ = minimised([this](const Eigen::VectorXd& at) { return cost(at); }, goes_on ? before : start,
                               goes_on ? 0.2 : 0.5, goes_on ? 100 : 300);
  prepare(hyperparameters_);
}

Eigen::MatrixXd Surrogate::correlation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const {
  Eigen::ArrayXXd squares = Eigen::ArrayXXd::Zero(a.rows(), b.rows());
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const double scale = 5 / (lengths_[j] * lengths_[j]);
    for (Eigen::Index k = 0; k < b.rows(); ++k) squares.col(k) += scale * (a.col(j).array() - b(k, j)).square();
  }
  return matern(squares);
}

void Surrogate::prepare(const Eigen::VectorXd& logarithms) {
  const Eigen::Index parameters = points_.cols();
  const Eigen::ArrayXd bounded = logarithms.array().max(-8).min(8);
  lengths_ = bounded.head(parameters).exp();
  process_ = std::exp(2 * bounded[parameters]);
  shared_ = std::exp(2 * bounded[parameters + 1]);
  own_ = std::exp(2 * bounded[parameters + 2]);
  Eigen::ArrayXXd squares = Eigen::ArrayXXd::Zero(values_.size(), values_.size());
  for (Eigen::Index j = 0; j < parameters; ++j)
    squares += 5 / (lengths_[j] * lengths_[j]) * squares_[std::size_t(j)].array();
  Eigen::MatrixXd covariance = process_ * matern(squares).matrix() + shared_ * same_specimen_;
  covariance.diagonal().array() += own_ + 1e-8;
  factor_.compute(covariance);
  const Eigen::MatrixXd terms = trend_at(points_);
  solved_trend_ = factor_.solve(terms);
  information_.compute(terms.transpose() * solved_trend_);
  trend_ = information_.solve(solved_trend_.transpose() * values_);
  const Eigen::VectorXd rest = values_ - terms * trend_;
  weights_ = factor_.solve(rest);
  misfit_ = rest.dot(weights_);
}

double Surrogate::cost(const Eigen::VectorXd& logarithms) {
  prepare(logarithms);
  const Eigen::Index parameters = points_.cols();
  const double determinant = factor_.matrixLLT().diagonal().array().abs().log().sum() +
                             information_.matrixLLT().diagonal().array().abs().log().sum();
  // Priors: lengths about the edge of the cube by a factor of 2; deviations about a third of that of the values by 4.
  const double prior = 0.5 * (logarithms.head(parameters) / 0.7).squaredNorm() +
                       0.5 * ((logarithms.tail(3).array() - usual_deviation) / 1.5).matrix().squaredNorm();
  const double found = 0.5 * misfit_ + determinant + prior;
  return std::isfinite(found) ? found : 1e300;
}

Prediction Surrogate::at(const Eigen::MatrixXd& points, std::size_t of_specimens) const {
  // The mean of n effects has the covariance shared/n with each of them, and with itself.
  const double of_effects = of_specimens > 0 ? shared_ / double(of_specimens) : 0;
  const Eigen::MatrixXd between = (process_ * correlation(points, points_)).array() + of_effects;
  const Eigen::MatrixXd terms = trend_at(points);
  const Eigen::MatrixXd half = factor_.matrixL().solve(between.transpose());
  const Eigen::MatrixXd rest = (terms - between * solved_trend_).transpose();
  const Eigen::MatrixXd of_trend = information_.matrixL().solve(rest);
  Prediction found;
  found.mean = (shift_ + scale_ * (terms * trend_ + between * weights_).array()).matrix();
  const Eigen::ArrayXd variance = process_ + of_effects - half.colwise().squaredNorm().transpose().array() +
                                  of_trend.colwise().squaredNorm().transpose().array();
  found.variance = (scale_ * scale_ * variance.max(0)).matrix();
  return found;
}

double Surrogate::scatter() const { return scale_ * std::sqrt(shared_ + own_); }

}  // namespace rvelab::fit
