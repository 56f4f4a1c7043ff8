// Stages that prescribe every component of the deformation: a constant gradient, or a list of deformation gradients.
#include <Eigen/LU>
#include <algorithm>

#include "rvelab/protocol/drive.hpp"

namespace rvelab::protocol {
namespace {

/// exp(h) - I by its series; increments are small, and halving keeps larger ones exact.
Matrix3 exponential_less_one(const Matrix3& h) {
  int halvings = 0;
  Matrix3 part = h;
  for (; part.cwiseAbs().maxCoeff() > 0.25; part *= 0.5) ++halvings;
  Matrix3 sum = Matrix3::Zero();
  for (int k = 16; k >= 1; --k) sum = part * (Matrix3::Identity() + sum) / k;
  for (; halvings > 0; --halvings) sum = Matrix3(2 * sum + sum * sum);
  return sum;
}

}  // namespace

void drive(RunningTest& test, const FlowStage& stage) {
  Progress& at = test.run.progress;
  at.axis = "";
  at.pressure = at.first_pressure;
  const std::vector<double> strains = record_strains(stage.to_strain, stage.record_every);
  test.go_through(strains, [&](double strain) {
    // Each from the one before it in the list: a flow has no target that round-off could miss.
    const double advance = strain - strains[static_cast<std::size_t>(at.step) - 1];
    return test.apply(exponential_less_one(advance * stage.gradient), {}, test.time_for(advance),
                      test.loading.held_tolerance);
  });
}

void drive(RunningTest& test, const DeformationStage& stage) {
  Progress& at = test.run.progress;
  at.axis = "";
  at.pressure = at.first_pressure;
  std::vector<double> numbers;
  for (std::size_t k = 0; k <= stage.gradients.size(); ++k) numbers.push_back(static_cast<double>(k));
  test.go_through(numbers, [&](double number) {
    const Matrix3& next = stage.gradients[static_cast<std::size_t>(number) - 1];
    const Matrix3 gradient = next * at.deformation.inverse() - Matrix3::Identity();
    const double size = (0.5 * (gradient + gradient.transpose())).norm();
    return test.apply(gradient, {}, test.time_for(size), test.loading.held_tolerance);
  });
}

}  // namespace rvelab::protocol
