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
  Progress& at = test.run.progress;
  while (at.step < most_increments) {
    const double present = mean_pressure(at.stress, test.dimension());
    const double reach = stage.largest_change * std::max(present, 0.1 * stage.pressure);
    const double rest = largest_gap(driven, at.stress);
    if (rest <= reach) return;
    std::vector<HeldStress> held = driven;
    for (auto& component : held) {
      component.target -= (1 - reach / rest) * gap(component, at.stress);
      component.scale = std::max(present, 0.1 * stage.pressure);
    }
    test.apply(Matrix3::Zero(), held, 0, test.loading.held_tolerance);
    ++at.step;
    test.pause();
  }
  throw test.failed("p = " + std::to_string(mean_pressure(at.stress, test.dimension())) + " Pa after " +
                    std::to_string(most_increments) + " increments; wanted: " + std::to_string(stage.pressure) +
                    " Pa; give a pressure that this packing can carry");
}

/// Phases of an isotropic stage (the last two make a round, until both tolerances are met) and of a relax stage (begun,
/// relaxing).
enum Phase : std::int32_t { begun = 1, approaching, correcting, relaxing };

}  // namespace

void drive(RunningTest& test, const IsotropicStage& stage) {
  const auto driven = targets(stage, test.dimension());
  Progress& at = test.run.progress;
  if (at.phase == begun) {
    if (stage.record) test.record_now(0);
    at.phase = approaching;
  }
  if (at.phase == approaching) {
    approach(test, stage, driven);
    at.unbalanced_ratio = test.rve.unbalanced_ratio();
    at.phase = correcting;
    at.step = 0;
  }
  const auto reached = [&] {
    return largest_gap(driven, at.stress) <= stage.stress_tolerance * stage.pressure &&
           at.unbalanced_ratio <= stage.unbalanced;
  };
  while (at.phase == relaxing || (at.step < stage.max_rounds && !reached())) {
    if (at.phase == correcting) {
      // Half the tolerance: the relaxation that follows moves the stress a little.
      if (largest_gap(driven, at.stress) > 0.5 * stage.stress_tolerance * stage.pressure) {
        test.apply(Matrix3::Zero(), driven, 0, 0.5 * stage.stress_tolerance);
      }
      at.phase = relaxing;
    }
    at.unbalanced_ratio = test.relax(stage.unbalanced, stage.max_steps).unbalanced_ratio;
    at.phase = correcting;
    ++at.step;
    test.pause();
  }
  if (!reached()) {
    std::ostringstream text;
    text << "the normal stresses miss -" << stage.pressure << " Pa by "
         << largest_gap(driven, at.stress) / stage.pressure << " of it (allowed " << stage.stress_tolerance
         << ") at the unbalanced ratio " << at.unbalanced_ratio << " (allowed " << stage.unbalanced << ") after "
         << stage.max_rounds << " rounds; raise max_rounds, max_steps or the tolerances";
    throw test.failed(text.str());
  }
  if (stage.record) test.record_now(1 - at.deformation.determinant());
}

void drive(RunningTest& test, const RelaxStage& stage) {
  if (test.run.progress.phase == begun) {
    if (stage.record) test.record_now(0);
    test.run.progress.phase = relaxing;
  }
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
