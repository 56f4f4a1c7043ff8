#include "rvelab/fit/surrogate.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/fit/minimise.hpp"

namespace rvelab::fit {
namespace {

/// Constant and linear terms of the trend.
Eigen::MatrixXd trend_at(const Eigen::MatrixXd& places) {
  Eigen::MatrixXd terms(places.rows(), places.cols() + 1);
  terms << Eigen::VectorXd::Ones(places.rows()), places;
  return terms;
}

}  // namespace

Surrogate::Surrogate(const Eigen::MatrixXd& places, const std::vector<std::size_t>& specimens,
                     const Eigen::VectorXd& values)
    : places_(places), same_specimen_(values.size(), values.size()) {
  const Eigen::Index count = values.size(), parameters = places.cols();
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      same_specimen_(i, j) = specimens[std::size_t(i)] == specimens[std::size_t(j)] ? 1 : 0;
  shift_ = values.mean();
  scale_ = std::sqrt((values.array() - shift_).square().mean());
  if (!(scale_ > 0)) scale_ = 1;
  values_ = (values.array() - shift_) / scale_;
  // Logarithms of the lengths, then of the standard deviations of specimen and test.
  Eigen::VectorXd start = Eigen::VectorXd::Zero(parameters + 2);
  start.tail(2).setConstant(-1);
  prepare(minimised([this](const Eigen::VectorXd& at) { return cost(at); }, start));
}

Eigen::MatrixXd Surrogate::correlation(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const {
  const Eigen::MatrixXd left = a * lengths_.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd right = b * lengths_.cwiseInverse().asDiagonal();
  Eigen::MatrixXd found(a.rows(), b.rows());
  for (Eigen::Index j = 0; j < b.rows(); ++j) {
    const Eigen::ArrayXd r = (5 * (left.rowwise() - right.row(j)).rowwise().squaredNorm()).array().sqrt();
    found.col(j) = (1 + r + r.square() / 3) * (-r).exp();
  }
  return found;
}

void Surrogate::prepare(const Eigen::VectorXd& logarithms) {
  const Eigen::Index parameters = places_.cols(), count = values_.size();
  const Eigen::ArrayXd bounded = logarithms.array().max(-8).min(8);
  lengths_ = bounded.head(parameters).exp();
  shared_ = std::exp(2 * bounded[parameters]);
  own_ = std::exp(2 * bounded[parameters + 1]);
  Eigen::MatrixXd covariance = correlation(places_, places_) + shared_ * same_specimen_;
  covariance.diagonal().array() += own_ + 1e-8;
  factor_.compute(covariance);
  const Eigen::MatrixXd terms = trend_at(places_);
  solved_trend_ = factor_.solve(terms);
  information_.compute(terms.transpose() * solved_trend_);
  trend_ = information_.solve(solved_trend_.transpose() * values_);
  const Eigen::VectorXd rest = values_ - terms * trend_;
  weights_ = factor_.solve(rest);
  variance_ = std::max(rest.dot(weights_) / double(count - terms.cols()), 1e-300);
}

double Surrogate::cost(const Eigen::VectorXd& logarithms) {
  prepare(logarithms);
  const Eigen::Index parameters = places_.cols();
  const double freedom = double(values_.size() - parameters - 1);
  const double determinant = factor_.matrixLLT().diagonal().array().abs().log().sum() +
                             information_.matrixLLT().diagonal().array().abs().log().sum();
  // Priors: lengths about the edge of the cube by a factor of 2; scatter about a third of the process by a factor of 4.
  const double prior = 0.5 * (logarithms.head(parameters) / 0.7).squaredNorm() +
                       0.5 * ((logarithms.tail(2).array() + 1) / 1.5).matrix().squaredNorm();
  const double found = 0.5 * freedom * std::log(variance_) + determinant + prior;
  return std::isfinite(found) ? found : 1e300;
}

Prediction Surrogate::at(const Eigen::MatrixXd& places) const {
  const Eigen::MatrixXd between = correlation(places, places_), terms = trend_at(places);
  const Eigen::MatrixXd half = factor_.matrixL().solve(between.transpose());
  const Eigen::MatrixXd rest = (terms - between * solved_trend_).transpose();
  const Eigen::MatrixXd of_trend = information_.matrixL().solve(rest);
  Prediction found;
  found.mean = (shift_ + scale_ * (terms * trend_ + between * weights_).array()).matrix();
  const Eigen::ArrayXd variance =
      1 - half.colwise().squaredNorm().transpose().array() + of_trend.colwise().squaredNorm().transpose().array();
  found.variance = (scale_ * scale_ * variance_ * variance.max(0)).matrix();
  return found;
}

double Surrogate::scatter() const { return scale_ * std::sqrt(variance_ * (shared_ + own_)); }

}  // namespace rvelab::fit
