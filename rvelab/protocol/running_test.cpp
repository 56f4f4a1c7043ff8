#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/protocol/drive.hpp"

namespace rvelab::protocol {
namespace {

/// E with E : dE = dE_ij for symmetric dE.
Matrix3 selector(int i, int j) {
  Matrix3 tensor = Matrix3::Zero();
  tensor(i, j) += 0.5;
  tensor(j, i) += 0.5;
  return tensor;
}

}  // namespace

std::vector<std::pair<int, int>> components(int dimension) {
  if (dimension == 2) return {{0, 0}, {1, 1}, {0, 1}};
  return {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
}

MixedTarget mixed_target(const Matrix3& displacement_gradient, const std::vector<HeldStress>& held,
                         const Matrix3& stress, int dimension) {
  MixedTarget target;
  target.spin = 0.5 * (displacement_gradient - displacement_gradient.transpose());
  const Matrix3 strain = 0.5 * (displacement_gradient + displacement_gradient.transpose());
  for (const auto& [i, j] : components(dimension)) {
    MixedTarget::Row row;
    row.strain = selector(i, j);
    row.value = strain(i, j);
    for (const HeldStress& component : held) {
      if (component.i != i || component.j != j) continue;
      row.stress = selector(i, j);
      row.strain.setZero();
      // From the stress as it is: what the increment before missed is made good, not carried on.
      row.value = component.target - 0.5 * (stress(i, j) + stress(j, i));
      row.scale = component.scale;
    }
    target.rows.push_back(row);
  }
  return target;
}

RunningTest::RunningTest(const Protocol& protocol, const Specimen& specimen, const OnRecord& on_record)
    : rve(specimen), loading(protocol.loading), stress(rve.stress()), on_record_(on_record) {}

Error RunningTest::failed(const std::string& text) const { return Error("stage \"" + stage_name_ + "\": " + text); }

void RunningTest::begin_stage(const Stage& stage) {
  stage_name_ = stage.name;
  run.result.stages.push_back(stage.name);
  deformation = Matrix3::Identity();
  stress = rve.stress();
  first_pressure = mean_pressure(stress, dimension());
  substeps_ = 0;
  rate_ = loading.rate;
  if (loading.physical && loading.inertial_number > 0) {
    const Network network = rve.network();
    // I = rate d sqrt(rho/p), with the driving strain's rate (design 3)
    rate_ = first_pressure > 0
                ? loading.inertial_number * std::sqrt(first_pressure / solid_density(network)) / mean_diameter(network)
                : 0;
  }
}

double RunningTest::held_scale(double target) const {
  const double scale = std::max(std::abs(target), 0.01 * std::abs(first_pressure));
  if (scale > 0) return scale;
  throw failed(
      "a stress of 0 Pa cannot be held from a state without pressure; allowed: a pressure > 0; compress first");
}

double RunningTest::time_for(double strain_increment) const {
  if (!loading.physical) return 0;
  if (rate_ > 0) return std::abs(strain_increment) / rate_;
  throw failed("loading.inertial_number gives no rate at p = " + std::to_string(first_pressure) +
               " Pa; allowed: p > 0 at the start of the stage; give loading.rate_1_s");
}

Report RunningTest::apply(const Matrix3& displacement_gradient, const std::vector<HeldStress>& held, double dt,
                          double tolerance) {
  Response response;
  try {
    if (held.empty()) {
      response = rve.apply(displacement_gradient, dt);
      response.displacement_gradient = displacement_gradient;
    } else {
      MixedTarget target = mixed_target(displacement_gradient, held, stress, dimension());
      target.tolerance = tolerance;
      target.wait = loading.held_wait;
      response = rve.apply(target, dt);
    }
  } catch (const InvalidIncrement& error) {
    throw InvalidIncrement("stage \"" + stage_name_ + "\": " + error.what());
  } catch (const IncrementFailed& error) {
    throw IncrementFailed("stage \"" + stage_name_ + "\": " + error.what());
  }
  deformation = (Matrix3::Identity() + response.displacement_gradient) * deformation;
  stress = response.stress;
  substeps_ += response.report.substeps;
  return response.report;
}

Report RunningTest::relax(double unbalanced, long max_steps) {
  const Report report = rve.relax(unbalanced, max_steps);
  stress = rve.stress();
  substeps_ += report.substeps;
  return report;
}

void RunningTest::record(double strain, const Report& report) {
  const Network network = rve.network();
  Record record;
  record.stage = static_cast<int>(run.result.stages.size()) - 1;
  record.strain = strain;
  record.deformation_gradient = deformation;
  record.stress = stress;
  record.void_ratio = void_ratio(network);
  record.coordination_number = coordination_number(network);
  record.fabric_anisotropy = fabric_anisotropy(fabric(network), dimension());
  record.sliding_fraction = sliding_fraction(network);
  record.unbalanced_force_ratio = report.unbalanced_ratio;
  record.inertial_number = report.inertial_number;
  record.substeps = substeps_;
  record.held_error = report.held_error;
  record.target_held = report.target_held;
  substeps_ = 0;
  run.result.records.push_back(record);
  if (on_record_) on_record_(run.result.records.back());
}

void RunningTest::record_now(double strain) {
  Report report;
  report.unbalanced_ratio = rve.unbalanced_ratio();
  record(strain, report);
}

}  // namespace rvelab::protocol
