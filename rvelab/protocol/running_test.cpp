#include <algorithm>
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

RunningTest::RunningTest(const Protocol& protocol, const Specimen& specimen, const Watch& watch)
    : rve(specimen),
      loading(protocol.loading),
      watch_(watch),
      snapshots_every_(protocol.snapshots_every),
      records_planned_(planned_records(protocol)) {
  run.result.protocol = protocol.name;
  rve.watch(watch.stop);
  rve.share(watch.team);
}

Error RunningTest::failed(const std::string& text) const { return Error("stage \"" + stage_name_ + "\": " + text); }

void RunningTest::enter(const Stage& stage) {
  stage_name_ = stage.name;
  Progress& at = run.progress;
  if (at.phase > 0) return;
  run.result.stages.push_back(stage.name);
  at.deformation = Matrix3::Identity();
  at.stress = rve.stress();
  at.first_pressure = mean_pressure(at.stress, dimension());
  at.substeps = 0;
  at.rate = loading.rate;
  if (loading.physical && loading.inertial_number > 0) {
    const Network network = rve.network();
    // I = rate d sqrt(rho/p), with the driving strain's rate (design 3)
    at.rate = at.first_pressure > 0 ? loading.inertial_number * std::sqrt(at.first_pressure / solid_density(network)) /
                                          mean_diameter(network)
                                    : 0;
  }
  at.phase = 1;
  at.step = 0;
}

void RunningTest::leave_stage() {
  Progress& at = run.progress;
  ++at.stage;
  at.phase = 0;
  at.step = 0;
  pause();
}

void RunningTest::pause() {
  clock();
  if (watch_.on_moment) watch_.on_moment({run.progress, run.result, rve, records_planned_});
  if (watch_.stop != nullptr && watch_.stop->load()) throw Interrupted();
}

double RunningTest::held_scale(double target) const {
  const double scale = std::max(std::abs(target), 0.01 * std::abs(run.progress.first_pressure));
  if (scale > 0) return scale;
  throw failed(
      "a stress of 0 Pa cannot be held from a state without pressure; allowed: a pressure > 0; compress first");
}

double RunningTest::time_for(double strain_increment) const {
  if (!loading.physical) return 0;
  if (run.progress.rate > 0) return std::abs(strain_increment) / run.progress.rate;
  throw failed("loading.inertial_number gives no rate at p = " + std::to_string(run.progress.first_pressure) +
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
      MixedTarget target = mixed_target(displacement_gradient, held, run.progress.stress, dimension());
      target.tolerance = tolerance;
      target.wait = loading.held_wait;
      response = rve.apply(target, dt);
    }
  } catch (const InvalidIncrement& error) {
    throw InvalidIncrement("stage \"" + stage_name_ + "\": " + error.what());
  } catch (const IncrementFailed& error) {
    throw IncrementFailed("stage \"" + stage_name_ + "\": " + error.what());
  }
  Progress& at = run.progress;
  at.deformation = (Matrix3::Identity() + response.displacement_gradient) * at.deformation;
  at.stress = response.stress;
  at.substeps += response.report.substeps;
  return response.report;
}

Report RunningTest::relax(double unbalanced, long max_steps) {
  // Slices of about a second, between which a checkpoint can be taken. Each call of Rve::relax scales the masses anew,
  // so their length must depend on nothing but the specimen.
  constexpr long stretch = 25, grain_steps = 20'000'000;
  const long slice = stretch * std::clamp(grain_steps / (stretch * static_cast<long>(rve.size() + 1)), 10L, 1000L);
  Progress& at = run.progress;
  while (true) {
    Report report = rve.relax(unbalanced, std::min(slice, max_steps - static_cast<long>(at.relaxation_steps)));
    at.stress = rve.stress();
    at.substeps += report.substeps;
    at.relaxation_steps += report.substeps;
    if (report.target_held || at.relaxation_steps >= max_steps) {
      report.substeps = at.relaxation_steps;
      at.relaxation_steps = 0;
      return report;
    }
    pause();
  }
}

void RunningTest::record(double strain, const Report& report) {
  const Network network = rve.network();
  Record record;
  record.stage = static_cast<int>(run.result.stages.size()) - 1;
  record.strain = strain;
  record.deformation_gradient = run.progress.deformation;
  record.stress = run.progress.stress;
  record.void_ratio = void_ratio(network);
  record.coordination_number = coordination_number(network);
  record.fabric_anisotropy = fabric_anisotropy(fabric(network), dimension());
  record.sliding_fraction = sliding_fraction(network);
  record.unbalanced_force_ratio = report.unbalanced_ratio;
  record.inertial_number = report.inertial_number;
  record.substeps = run.progress.substeps;
  record.held_error = report.held_error;
  record.target_held = report.target_held;
  run.progress.substeps = 0;
  const std::size_t number = run.result.records.size();
  run.result.records.push_back(record);
  ++run.progress.records;
  if (watch_.on_record) watch_.on_record(record);
  if (watch_.on_snapshot && snapshots_every_ > 0 && number % static_cast<std::size_t>(snapshots_every_) == 0) {
    watch_.on_snapshot(number, rve.specimen());
  }
}

void RunningTest::probed(const Eigen::MatrixXd& stiffness) {
  run.result.probes.push_back({stage_name_, stiffness});
  ++run.progress.probes;
  if (watch_.on_probe) watch_.on_probe(run.result.probes.back());
}

void RunningTest::record_now(double strain) {
  Report report;
  report.unbalanced_ratio = rve.unbalanced_ratio();
  record(strain, report);
}

}  // namespace rvelab::protocol
