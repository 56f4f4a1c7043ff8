// Isotropic stages: far changes of pressure in small increments, then rounds of relaxing and correcting.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/protocol/drive.hpp"

namespace rvelab::protocol {
namespace {

constexpr int most_increments = 1000;

/// Targets of the driven components, Pa: -p on the diagonal, 0 beside it.
std::vector<HeldStress> targets(const IsotropicStage& stage, int dimension) {
  std::vector<HeldStress> driven;
  for (const auto& [i, j] : components(dimension)) {
    if (i == j) driven.push_back({i, j, -stage.pressure, stage.pressure});
    if (i != j && stage.shear_stress_free) driven.push_back({i, j, 0.0, stage.pressure});
  }
  return driven;
}

double gap(const HeldStress& component, const Matrix3& stress) {
  const int i = component.i, j = component.j;
  return component.target - 0.5 * (stress(i, j) + stress(j, i));
}

double largest_gap(const std::vector<HeldStress>& driven, const Matrix3& stress) {
  double largest = 0;
  for (const auto& component : driven) largest = std::max(largest, std::abs(gap(component, stress)));
  return largest;
}

/// Increments of at most largest_change of the present pressure (geometric), until the rest is one increment.
void approach(RunningTest& test, const IsotropicStage& stage, const std::vector<HeldStress>& driven) {
  for (int increment = 0; increment < most_increments; ++increment) {
    const double present = mean_pressure(test.stress, test.dimension());
    const double reach = stage.largest_change * std::max(present, 0.1 * stage.pressure);
    const double rest = largest_gap(driven, test.stress);
    if (rest <= reach) return;
    std::vector<HeldStress> held = driven;
    for (auto& component : held) {
      component.target -= (1 - reach / rest) * gap(component, test.stress);
      component.scale = std::max(present, 0.1 * stage.pressure);
    }
    test.apply(Matrix3::Zero(), held, 0, test.loading.held_tolerance);
  }
  throw test.failed("p = " + std::to_string(mean_pressure(test.stress, test.dimension())) + " Pa after " +
                    std::to_string(most_increments) + " increments; wanted: " + std::to_string(stage.pressure) +
                    " Pa; give a pressure that this packing can carry");
}

}  // namespace

void drive(RunningTest& test, const IsotropicStage& stage) {
  const auto driven = targets(stage, test.dimension());
  if (stage.record) test.record_now(0);
  approach(test, stage, driven);
  double unbalanced = test.rve.unbalanced_ratio();
  const auto reached = [&] {
    return largest_gap(driven, test.stress) <= stage.stress_tolerance * stage.pressure &&
           unbalanced <= stage.unbalanced;
  };
  for (long round = 0; round < stage.max_rounds && !reached(); ++round) {
    // Half the tolerance: the relaxation that follows moves the stress a little.
    if (largest_gap(driven, test.stress) > 0.5 * stage.stress_tolerance * stage.pressure) {
      test.apply(Matrix3::Zero(), driven, 0, 0.5 * stage.stress_tolerance);
    }
    unbalanced = test.relax(stage.unbalanced, stage.max_steps).unbalanced_ratio;
  }
  if (!reached()) {
    std::ostringstream text;
    text << "the normal stresses miss -" << stage.pressure << " Pa by "
         << largest_gap(driven, test.stress) / stage.pressure << " of it (allowed " << stage.stress_tolerance
         << ") at the unbalanced ratio " << unbalanced << " (allowed " << stage.unbalanced << ") after "
         << stage.max_rounds << " rounds; raise max_rounds, max_steps or the tolerances";
    throw test.failed(text.str());
  }
  if (stage.record) test.record_now(1 - test.deformation.determinant());
}

void drive(RunningTest& test, const RelaxStage& stage) {
  if (stage.record) test.record_now(0);
  const Report report = test.relax(stage.unbalanced, stage.max_steps);
  if (report.unbalanced_ratio > stage.unbalanced) {
    std::ostringstream text;
    text << "the unbalanced ratio is " << report.unbalanced_ratio << " after " << report.substeps
         << " steps; wanted: " << stage.unbalanced << "; raise max_steps or unbalanced";
    throw test.failed(text.str());
  }
  if (stage.record) test.record_now(0);
}

}  // namespace rvelab::protocol
