// The servo: turns a mixed target A : dE + B : d sigma = c into strain, a few sub-steps at a time.
//
// Each row is a constraint on strain (B = 0) or on stress. At each of its updates, one a segment of the target, it
// solves (A + B C) d eps = r with the affine stiffness C of the contact network and r what the rows still lack: rows of
// strain in full, rows with stress by half, plus an integral term (proportional and integral control). The map from
// stress error to strain rate is positive real and the specimen is passive, so the loop is stable without any gain to
// tune.
#pragma once

#include "rvelab/solver/assembly/affine_stiffness.hpp"
#include "rvelab/solver/loading/mixed_target.hpp"

namespace rvelab {

class Servo {
 public:
  /// What an increment before has missed of a row: made good evenly over this one, or as fast as the gain allows.
  enum class Missed { evenly, at_once };

  /// Checks the target (InputError: wrong number of rows, dependent rows, no scale, not finite).
  Servo(const MixedTarget& target, int dimension, const Matrix3& stress_at_start, Missed missed);

  /// Renews the gain; stiffness in the laboratory frame. `floor` (Pa) keeps it regular when nothing touches.
  void set_stiffness(const Matrix6& stiffness, double floor);
  /// At a rate, after set_stiffness: the dashpots, Pa s, for updates every `time` (s).
  void set_viscosity(const Matrix6& viscosity, double time);

  /// Norm of the strain that the whole target asks for by the present gain.
  double predicted_strain() const;

  /// Strain of the next segment, symmetric: the target's fraction goes on to `to` (in [0, 1]).
  /// `planned_strain` is the share of the predicted strain that the segment makes, `full_strain` what a full segment
  /// would; the answer to stress errors is cut at `limit`. `integral` is the strain per unit of planned strain that the
  /// sum of the errors has found (laboratory frame); it is updated.
  Matrix3 next_strain(double to, double planned_strain, double full_strain, double limit, const Matrix3& strain_so_far,
                      const Matrix3& stress, Matrix3& integral);

  /// The same at a rate. The dashpots answer a rate and let go of it when it ends: an update changes the stress by
  /// K de + C (de/time - rate), with `rate` (1/s) that of the update before, and is solved for de. (With K alone a
  /// restitution of 0.1 made the servo swing by 1 to 5 times the stress that it held; with K + C/time for every strain
  /// it followed no faster than a collision, 4 to 16 % of scatter instead of 1 to 2.) The answer is cut at `limit`.
  Matrix3 next_strain_at_rate(double to, double planned_strain, double full_strain, double limit,
                              const Matrix3& strain_so_far, const Matrix3& stress, const Matrix3& rate,
                              Matrix3& integral);

  /// What the rows lack at a fraction of the target.
  Vector6 residual(double fraction, const Matrix3& strain, const Matrix3& stress) const;
  /// Largest |residual| / scale over the rows that involve stress.
  double largest_error(const Vector6& residual) const;
  /// The same at the end of the target.
  double held_error(const Matrix3& strain_so_far, const Matrix3& stress) const {
    return largest_error(residual(1.0, strain_so_far, stress));
  }

  /// Largest stress that the scales of the rows stand for, Pa; 0 without a row of stress.
  double held_stress() const;

 private:
  /// (A + B stiffness)^-1 over the components in use.
  Matrix6 inverse_rows(const Matrix6& stiffness) const;
  /// The rows that involve stress, or the others; zero elsewhere.
  Vector6 rows_of(bool stress, const Vector6& rows) const;

  int rows_;
  bool stress_row_[6] = {};
  double scale_[6] = {};
  Matrix6 a_ = Matrix6::Zero(), b_ = Matrix6::Zero(), gain_ = Matrix6::Zero();
  Vector6 c_ = Vector6::Zero(), at_once_ = Vector6::Zero(), total_ = Vector6::Zero();
  Matrix6 stiffness_ = Matrix6::Zero(), viscosity_ = Matrix6::Zero(), quick_gain_ = Matrix6::Zero();
  Matrix3 start_stress_;
};

}  // namespace rvelab
