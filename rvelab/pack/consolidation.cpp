#include "rvelab/pack/consolidation.hpp"

#include <cmath>
#include <limits>

#include "rvelab/cell/cell.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::pack {

namespace {

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

/// An assembly by itself: consolidated without a pause.
struct Assembly {
  struct Place {
    Matrix3 stress;
    std::int32_t phase = approaching;
    long step = 0;
    double unbalanced_ratio = std::numeric_limits<double>::infinity();  ///< at least one round is made
  };
  Rve& rve;
  const StressGoal& goal;
  Matrix3& deformation;
  StepsLeft* left;
  Place at;

  void spend(long substeps) {
    if (left == nullptr) return;
    left->made += substeps;
    if (left->on_spent) left->on_spent(left->made);
    if (left->made <= left->most) return;
    throw NotAtRest("the grains do not come to rest at the stress: " + rest_in_words(rve, goal, left->made));
  }

  void bring(const Matrix3& to, double scale, double tolerance) {
    const Response response = rve.apply(toward(goal, to, at.stress, scale, tolerance), 0);
    deformation += response.displacement_gradient * deformation;
    at.stress = response.stress;
    spend(response.report.substeps);
  }
  static double on_the_way() { return 5e-3; }
  void relax(double unbalanced, long max_steps) {
    const Report report = rve.relax(unbalanced, max_steps);
    at.stress = rve.stress();
    at.unbalanced_ratio = report.target_held ? 0 : std::numeric_limits<double>::infinity();
    spend(report.substeps);
  }
  void arrived() {}
  void pause() {}
};

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
  const double reach = largest_change * std::max({mean_pressure(stress, goal.dimension), 0.1 * goal.pressure(),
                                                  goal.pressure() > 0 ? 0 : goal.least_pressure});
  const double rest = largest_gap(goal, stress);
  if (rest <= reach) return goal.stress;
  return goal.stress - (1 - reach / rest) * (goal.stress - symmetric(stress));
}

Matrix3 upright_again(const Matrix3& deformation, const Matrix3& frame) {
  const Matrix3 turned = triangular_factors(frame.transpose() * deformation * frame).rotation;
  return frame * turned.transpose() * frame.transpose() - Matrix3::Identity();
}

std::string rest_in_words(const Rve& rve, const StressGoal& goal, long substeps) {
  const Network network = rve.network();
  const double contacts = double(network.contacts.size()) / double(rve.size());
  return "after " + std::to_string(substeps) + " sub-steps the unbalanced ratio is " +
         in_words(rve.unbalanced_ratio()) + ", and the stress is off by " +
         in_words(largest_gap(goal, rve.stress()) / goal.pressure()) + " of the pressure; void ratio " +
         in_words(void_ratio(network)) + ", " + in_words(contacts) + " contacts a grain";
}

bool consolidate(Rve& rve, const StressGoal& goal, const Rest& rest, Matrix3& deformation, StepsLeft* left) {
  Assembly assembly{rve, goal, deformation, left, {rve.stress()}};
  return consolidate(assembly, goal, rest, goal.pressure()) == Consolidated::reached;
}

}  // namespace rvelab::pack
