// Stages driven by a strain: one increment for each record, which ends exactly at the recorded strain.
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/path_rows.hpp"

namespace rvelab::protocol {
namespace {

int axis_index(char axis) { return axis - 'x'; }

/// "-sigma_xx": what messages call a normal stress, compression positive.
std::string normal_stress(int k) { return std::string("-sigma_") + "xyz"[k] + "xyz"[k]; }

}  // namespace

std::vector<double> record_strains(double to_strain, double spacing) {
  std::vector<double> strains{0};
  const double direction = to_strain < 0 ? -1 : 1;
  // A last interval below a millionth of the spacing is round-off of the file's numbers.
  const auto whole = static_cast<long>(std::abs(to_strain) / spacing - 1e-6);
  for (long k = 1; k <= whole; ++k) strains.push_back(direction * static_cast<double>(k) * spacing);
  strains.push_back(to_strain);
  return strains;
}

/// Records on the way to one amplitude.
long steps_to(double to_strain, double spacing) { return std::max(1L, std::lround(std::abs(to_strain) / spacing)); }

/// Of compression or simple shear; where a stress turns it, those that it makes if none does.
template <class Driven>
std::size_t driven_records(const Driven& stage) {
  if (stage.cycles.count == 0) return record_strains(stage.to_strain, stage.record_every).size();
  return static_cast<std::size_t>(4 * stage.cycles.count * steps_to(stage.to_strain, stage.record_every)) + 1;
}

}  // namespace rvelab::protocol

namespace rvelab {

std::size_t planned_records(const Protocol& protocol) {
  using namespace protocol;
  std::size_t count = 0;
  for (const Stage& stage : protocol.stages) {
    if (const auto* compression = std::get_if<CompressionStage>(&stage.what)) {
      count += driven_records(*compression);
    } else if (const auto* shear = std::get_if<SimpleShearStage>(&stage.what)) {
      count += driven_records(*shear);
    } else if (const auto* path = std::get_if<PathStage>(&stage.what)) {
      count += static_cast<std::size_t>(path_steps(*path)) + 1;
    } else if (const auto* deviatoric = std::get_if<DeviatoricStage>(&stage.what)) {
      count += static_cast<std::size_t>(path_steps(path_of(*deviatoric, 3))) + 1;
    } else if (const auto* pressures = std::get_if<PressurePathStage>(&stage.what)) {
      count += static_cast<std::size_t>(path_steps(path_of(*pressures, 2))) + 1;
    } else if (const auto* flow = std::get_if<FlowStage>(&stage.what)) {
      count += record_strains(flow->to_strain, flow->record_every).size();
    } else if (const auto* deformation = std::get_if<DeformationStage>(&stage.what)) {
      count += deformation->gradients.size() + 1;
    } else if (const auto* envelope = std::get_if<EnvelopeStage>(&stage.what)) {
      count += static_cast<std::size_t>(envelope->directions) + 1;
    } else if (const auto* isotropic = std::get_if<IsotropicStage>(&stage.what)) {
      count += isotropic->record ? 2 : 0;
    } else if (const auto* relax = std::get_if<RelaxStage>(&stage.what)) {
      count += relax->record ? 2 : 0;
    }
  }
  return count;
}

}  // namespace rvelab

namespace rvelab::protocol {
namespace {

template <class Stage, class Increment, class DrivingStress>
void drive_strain(RunningTest& test, const Stage& stage, Increment increment_to, DrivingStress driving_stress) {
  if (stage.cycles.count == 0)
    return test.go_through(record_strains(stage.to_strain, stage.record_every), increment_to);
  test.go_to_and_fro(stage.to_strain, steps_to(stage.to_strain, stage.record_every), stage.cycles, increment_to,
                     driving_stress);
}

}  // namespace

void drive(RunningTest& test, const CompressionStage& stage) {
  const int dimension = test.dimension();
  const std::string axis_name = !stage.axis.empty() ? stage.axis : dimension == 2 ? "y" : "z";
  const int axis = axis_index(axis_name[0]);
  const bool hold = stage.lateral == CompressionStage::Lateral::constant_stress;
  const bool undrained = stage.lateral == CompressionStage::Lateral::constant_volume;
  Progress& at = test.run.progress;
  at.axis = axis_name;
  at.pressure = hold ? stage.lateral_pressure : at.first_pressure;

  std::vector<HeldStress> held;
  for (int k = 0; k < dimension && hold; ++k) {
    if (k == axis) continue;
    if (at.step == 0) test.expect_consolidated(normal_stress(k), -at.first_stress(k, k), stage.lateral_pressure);
    held.push_back({k, k, -stage.lateral_pressure, test.held_scale(stage.lateral_pressure)});
  }
  const auto increment_to = [&](double strain) {
    // From the accumulated F, so that round-off does not add up over a stage.
    const Matrix3& deformation = at.deformation;
    const double stretch = 1 - strain;
    const double lateral_stretch = dimension == 2 ? 1 / stretch : std::sqrt(1 / stretch);
    Matrix3 gradient = Matrix3::Zero();
    for (int k = 0; k < dimension; ++k) {
      if (k == axis) gradient(k, k) = stretch / deformation(k, k) - 1;
      if (k != axis && undrained) gradient(k, k) = lateral_stretch / deformation(k, k) - 1;
    }
    return test.apply(gradient, held, test.time_for(gradient(axis, axis)), test.loading.held_tolerance);
  };
  drive_strain(test, stage, increment_to, [&] {
    double axial_less_lateral = -at.stress(axis, axis);
    for (int k = 0; k < dimension; ++k) {
      if (k != axis) axial_less_lateral += at.stress(k, k) / (dimension - 1);
    }
    return axial_less_lateral;
  });
}

void drive(RunningTest& test, const SimpleShearStage& stage) {
  const std::string plane = !stage.plane.empty() ? stage.plane : test.dimension() == 2 ? "xy" : "xz";
  const int along = axis_index(plane[0]), normal = axis_index(plane[1]);
  const bool hold = stage.normal == SimpleShearStage::Normal::constant_stress;
  Progress& at = test.run.progress;
  at.axis = plane;
  at.pressure = hold ? stage.normal_pressure : at.first_pressure;

  std::vector<HeldStress> held;
  if (hold && at.step == 0) {
    test.expect_consolidated(normal_stress(normal), -at.first_stress(normal, normal), stage.normal_pressure);
  }
  if (hold) held.push_back({normal, normal, -stage.normal_pressure, test.held_scale(stage.normal_pressure)});
  const auto increment_to = [&](double strain) {
    const Matrix3& deformation = at.deformation;
    Matrix3 gradient = Matrix3::Zero();
    gradient(along, normal) = (strain - deformation(along, normal)) / deformation(normal, normal);
    return test.apply(gradient, held, test.time_for(gradient(along, normal)), test.loading.held_tolerance);
  };
  drive_strain(test, stage, increment_to, [&] { return 0.5 * (at.stress(along, normal) + at.stress(normal, along)); });
}

}  // namespace rvelab::protocol
