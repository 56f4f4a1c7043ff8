#include "rvelab/solver/quasi_static/servo.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <string>

#include "rvelab/error.hpp"
#include "rvelab/solver/quasi_static/constants.hpp"

namespace rvelab {

using constants::integral_gain;
using constants::proportional_gain;

namespace {

/// Components in use: xx, yy, xy of the six in 2D.
constexpr int plane_components[3] = {0, 1, 5};

Vector6 stress_components(const Matrix3& s) {
  Vector6 v;
  v << s(0, 0), s(1, 1), s(2, 2), 0.5 * (s(1, 2) + s(2, 1)), 0.5 * (s(0, 2) + s(2, 0)), 0.5 * (s(0, 1) + s(1, 0));
  return v;
}

}  // namespace

Servo::Servo(const MixedTarget& target, int dimension, const Matrix3& stress_at_start, Missed missed)
    : start_stress_(stress_at_start) {
  rows_ = dimension == 2 ? 3 : 6;
  if (int(target.rows.size()) != rows_)
    throw InputError("mixed target: " + std::to_string(target.rows.size()) + " rows; " + std::to_string(dimension) +
                     "D needs " + std::to_string(rows_));
  if (!target.spin.allFinite() || (target.spin + target.spin.transpose()).norm() > 1e-12 * (1 + target.spin.norm()))
    throw InputError("mixed target: the spin must be a finite skew matrix");
  if (!(target.volume_ratio >= 0) || !std::isfinite(target.volume_ratio))
    throw InputError("mixed target: the volume ratio must be > 0 and finite, or 0 for none");
  if (!(target.tolerance > 0) || !std::isfinite(target.tolerance))
    throw InputError("mixed target: the tolerance must be > 0 and finite");
  Eigen::MatrixXd both(rows_, 12);
  for (int r = 0; r < rows_; ++r) {
    const auto& row = target.rows[std::size_t(r)];
    if (!row.strain.allFinite() || !row.stress.allFinite() || !std::isfinite(row.value + row.missed))
      throw InputError("mixed target: row " + std::to_string(r + 1) + " is not finite; give finite numbers");
    const Vector6 stress = strain_components(row.stress);  // B : sigma over six components counts shear twice
    Vector6 strain = strain_components(row.strain);
    strain.tail<3>() *= 0.5;  // A : eps with engineering shear
    a_.row(r) = strain.transpose();
    b_.row(r) = stress.transpose();
    c_[r] = row.value;
    if (missed == Missed::at_once) at_once_[r] = row.missed;
    stress_row_[r] = !stress.isZero(0);
    scale_[r] = row.scale;
    if (stress_row_[r] && !(row.scale > 0 && std::isfinite(row.scale)))
      throw InputError("mixed target: row " + std::to_string(r + 1) + " holds a stress and needs a scale > 0");
    both.row(r) << a_.row(r) / std::max(1e-300, a_.row(r).norm()), b_.row(r) / std::max(1e-300, b_.row(r).norm());
  }
  if (dimension == 2)
    for (int unused : {2, 3, 4}) {
      both.col(unused).setZero();
      both.col(6 + unused).setZero();
    }
  if (Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(both).rank() < rows_)
    throw InputError("mixed target: the rows depend on each other (or one is empty); give independent constraints");
}

Matrix6 Servo::inverse_rows(const Matrix6& stiffness) const {
  const Matrix6 full = a_ + b_ * stiffness;
  Eigen::MatrixXd m(rows_, rows_);
  for (int r = 0; r < rows_; ++r)
    for (int k = 0; k < rows_; ++k) m(r, k) = full(r, rows_ == 3 ? plane_components[k] : k);
  Eigen::VectorXd row_scale(rows_);
  for (int r = 0; r < rows_; ++r) {
    row_scale[r] = 1 / m.row(r).norm();
    m.row(r) *= row_scale[r];
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(m);
  if (!lu.isInvertible())
    throw InputError("mixed target: the rows do not determine the strain; give independent constraints");
  const Eigen::MatrixXd inverse = lu.inverse();
  Matrix6 strain = Matrix6::Zero();
  for (int k = 0; k < rows_; ++k)
    for (int r = 0; r < rows_; ++r) strain(rows_ == 3 ? plane_components[k] : k, r) = inverse(k, r) * row_scale[r];
  return strain;
}

void Servo::set_stiffness(const Matrix6& stiffness, double floor) {
  stiffness_ = stiffness;
  for (int k = 0; k < 6; ++k) stiffness_(k, k) += floor * (k < 3 ? 1.0 : 0.5);
  gain_ = inverse_rows(stiffness_);
  total_ = gain_ * (c_ - at_once_);
}

void Servo::set_viscosity(const Matrix6& viscosity, double time) {
  viscosity_ = viscosity;
  quick_gain_ = inverse_rows(stiffness_ + viscosity / time);
}

double Servo::predicted_strain() const { return strain_matrix(total_).norm(); }

Vector6 Servo::residual(double fraction, const Matrix3& strain, const Matrix3& stress) const {
  return fraction * (c_ - at_once_) + at_once_ - a_ * strain_components(strain) -
         b_ * stress_components(stress - start_stress_);
}

Vector6 Servo::rows_of(bool stress, const Vector6& rows) const {
  Vector6 part = Vector6::Zero();
  for (int k = 0; k < rows_; ++k)
    if (stress_row_[k] == stress) part[k] = rows[k];
  return part;
}

Matrix3 Servo::next_strain(double to, double planned_strain, double full_strain, double limit,
                           const Matrix3& strain_so_far, const Matrix3& stress, Matrix3& integral) {
  const Vector6 r = residual(to, strain_so_far, stress);
  const Matrix3 answer = strain_matrix(gain_ * rows_of(true, r));
  Matrix3 held = proportional_gain * answer + planned_strain * integral;
  const double size = held.norm();
  if (size > limit)
    held *= limit / size;
  else  // a short last segment says little about the rate: its weight is its share of a full one
    integral += (integral_gain * planned_strain / (full_strain * full_strain)) * answer;
  // Rows of strain get what `held` leaves of them: `integral` may stem from a target with other rows.
  return strain_matrix(gain_ * rows_of(false, r - a_ * strain_components(held))) + held;
}

Matrix3 Servo::next_strain_at_rate(double to, double planned_strain, double full_strain, double limit,
                                   const Matrix3& strain_so_far, const Matrix3& stress, const Matrix3& rate,
                                   Matrix3& integral) {
  const Vector6 r = residual(to, strain_so_far, stress);
  const Matrix3 answer = strain_matrix(gain_ * rows_of(true, r));
  // The strain that would leave the stress as it is, were there no dashpots; then what brings half of the error beside
  // it: K (de - steady) + C (de/time - rate) = half of the error, with the rows of strain met.
  const Vector6 steady =
      strain_components(planned_strain * integral +
                        strain_matrix(gain_ * rows_of(false, r - a_ * strain_components(planned_strain * integral))));
  const Vector6 wanted = proportional_gain * r + b_ * (stiffness_ * steady + viscosity_ * strain_components(rate));
  const Matrix3 strain = strain_matrix(quick_gain_ * (rows_of(false, r) + rows_of(true, wanted)));
  Matrix3 held = strain - strain_matrix(gain_ * rows_of(false, r));
  const double size = held.norm();
  if (size > limit)
    held *= limit / size;
  else
    integral += (integral_gain * planned_strain / (full_strain * full_strain)) * answer;
  return strain_matrix(gain_ * rows_of(false, r - a_ * strain_components(held))) + held;
}

double Servo::largest_error(const Vector6& r) const {
  double largest = 0;
  for (int k = 0; k < rows_; ++k)
    if (stress_row_[k]) largest = std::max(largest, std::abs(r[k]) / scale_[k]);
  return largest;
}

double Servo::held_stress() const {
  double largest = 0;
  for (int r = 0; r < rows_; ++r)
    if (stress_row_[r]) largest = std::max(largest, scale_[r] / b_.row(r).norm());
  return largest;
}

}  // namespace rvelab
