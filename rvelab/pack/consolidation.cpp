#include "rvelab/pack/consolidation.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/cell/givens.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::pack {

namespace {

constexpr int most_increments = 1000;
constexpr double held_tolerance = 5e-3;  ///< of increments on the way

Matrix3 symmetric(const Matrix3& m) { return 0.5 * (m + m.transpose()); }

/// One increment: driven components to `to`, the others without strain.
MixedTarget toward(const StressGoal& goal, const Matrix3& to, const Matrix3& present, double scale, double tolerance) {
  MixedTarget target;
  for (int i = 0; i < goal.dimension; ++i) {
    for (int j = i; j < goal.dimension; ++j) {
      MixedTarget::Row row;
      Matrix3& driven = i == j || goal.shear ? row.stress : row.strain;
      driven(i, j) += 0.5;
      driven(j, i) += 0.5;
      if (i == j || goal.shear) {
        row.value = to(i, j) - symmetric(present)(i, j);
        row.scale = scale;
      }
      target.rows.push_back(row);
    }
  }
  target.tolerance = tolerance;
  target.wait = short_wait;
  return target;
}

}  // namespace

double StressGoal::pressure() const { return mean_pressure(stress, dimension); }

double largest_gap(const StressGoal& goal, const Matrix3& stress) {
  const Matrix3 gap = goal.stress - symmetric(stress);
  double largest = 0;
  for (int i = 0; i < goal.dimension; ++i)
    for (int j = i; j < goal.dimension; ++j)
      if (i == j || goal.shear) largest = std::max(largest, std::abs(gap(i, j)));
  return largest;
}

Matrix3 next_stress(const StressGoal& goal, const Matrix3& stress, double largest_change) {
  const double reach = largest_change * std::max(mean_pressure(stress, goal.dimension), 0.1 * goal.pressure());
  const double rest = largest_gap(goal, stress);
  if (rest <= reach) return goal.stress;
  return goal.stress - (1 - reach / rest) * (goal.stress - symmetric(stress));
}

Matrix3 upright_again(const Matrix3& deformation, const Matrix3& frame) {
  const Matrix3 turned = triangular_factors(frame.transpose() * deformation * frame).rotation;
  return frame * turned.transpose() * frame.transpose() - Matrix3::Identity();
}

bool consolidate(Rve& rve, const StressGoal& goal, const Rest& rest, Matrix3& deformation) {
  const double pressure = goal.pressure();
  const auto apply = [&](const MixedTarget& target) {
    const Response response = rve.apply(target, 0);
    deformation += response.displacement_gradient * deformation;
    return response.stress;
  };
  Matrix3 stress = rve.stress();
  for (int k = 0; k < most_increments; ++k) {
    const Matrix3 next = next_stress(goal, stress, rest.largest_change);
    if ((next - goal.stress).isZero(0)) break;
    const double scale = std::max(mean_pressure(stress, goal.dimension), 0.1 * pressure);
    stress = apply(toward(goal, next, stress, scale, held_tolerance));
  }
  for (long round = 0; round < rest.max_rounds; ++round) {
    // Half the tolerance: the relaxation that follows moves the stress a little.
    if (largest_gap(goal, stress) > 0.5 * rest.stress_tolerance * pressure)
      apply(toward(goal, goal.stress, stress, pressure, 0.5 * rest.stress_tolerance));
    const Report report = rve.relax(rest.unbalanced, rest.max_steps);
    stress = rve.stress();
    if (report.target_held && largest_gap(goal, stress) <= rest.stress_tolerance * pressure) return true;
  }
  return false;
}

}  // namespace rvelab::pack
