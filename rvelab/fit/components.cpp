#include "rvelab/fit/components.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

namespace rvelab::fit {
namespace {

/// Principal directions of the columns, the largest first.
Eigen::MatrixXd principal_directions(const Eigen::MatrixXd& scaled, Eigen::Index most) {
  const Eigen::MatrixXd covariance = scaled.transpose() * scaled;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const Eigen::VectorXd variances = solver.eigenvalues().reverse();
  const Eigen::MatrixXd directions = solver.eigenvectors().rowwise().reverse();
  Eigen::Index count = 0;
  double held = 0;
  while (count < std::min(most, variances.size()) && (count == 0 || held < 0.99 * variances.sum()))
    held += variances[count++];
  return directions.leftCols(count);
}

}  // namespace

Components::Components(const std::vector<Target>& targets, const Eigen::MatrixXd& values, Eigen::Index parameters) {
  const auto count = Eigen::Index(targets.size());
  Eigen::VectorXd measured(count), errors(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    measured[k] = targets[std::size_t(k)].value;
    errors[k] = targets[std::size_t(k)].error;
  }
  shift_ = values.colwise().mean().transpose();
  const Eigen::VectorXd squares = (values.rowwise() - shift_.transpose()).colwise().squaredNorm().transpose();
  scale_ = (squares / double(values.rows()) + errors.cwiseAbs2()).cwiseSqrt().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = (values.rowwise() - shift_.transpose()) * scale_.cwiseInverse().asDiagonal();
  std::map<int, std::vector<Eigen::Index>> curves;
  std::vector<Eigen::VectorXd> directions;
  for (Eigen::Index k = 0; k < count; ++k) {
    if (targets[std::size_t(k)].curve >= 0)
      curves[targets[std::size_t(k)].curve].push_back(k);
    else
      directions.emplace_back(Eigen::VectorXd::Unit(count, k));
  }
  for (const auto& [curve, points] : curves) {
    const Eigen::MatrixXd own = principal_directions(scaled(Eigen::all, points), parameters + 2);
    for (Eigen::Index c = 0; c < own.cols(); ++c) {
      Eigen::VectorXd direction = Eigen::VectorXd::Zero(count);
      direction(points) = own.col(c);
      directions.push_back(direction);
    }
  }
  directions_.resize(count, Eigen::Index(directions.size()));
  for (std::size_t c = 0; c < directions.size(); ++c) directions_.col(Eigen::Index(c)) = directions[c];
  target_ = directions_.transpose() * (measured - shift_).cwiseQuotient(scale_);
  error_ = directions_.cwiseAbs().transpose() * errors.cwiseQuotient(scale_);
  for (Eigen::Index c = 0; c < directions_.cols(); ++c) {
    Eigen::Index largest = 0;
    directions_.col(c).cwiseAbs().maxCoeff(&largest);
    const std::optional<double> common = targets[std::size_t(largest)].common;
    if (!common) continue;
    const Eigen::VectorXd parts = directions_.col(c).cwiseProduct(errors.cwiseQuotient(scale_));
    error_[c] = std::sqrt(*common * std::pow(parts.sum(), 2) + (1 - *common) * parts.squaredNorm());
  }
}

Eigen::MatrixXd Components::of(const Eigen::MatrixXd& values) const {
  return (values.rowwise() - shift_.transpose()) * scale_.cwiseInverse().asDiagonal() * directions_;
}

Eigen::MatrixXd Components::back(const Eigen::MatrixXd& scores) const {
  return ((scores * directions_.transpose()) * scale_.asDiagonal()).rowwise() + shift_.transpose();
}

}  // namespace rvelab::fit
