// Stages driven by a strain: one increment for each record, which ends exactly at the recorded strain.
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/protocol/drive.hpp"

namespace rvelab::protocol {
namespace {

int axis_index(char axis) { return axis - 'x'; }

void expect_axes(const RunningTest& test, const std::string& axes, const std::string& key) {
  if (test.dimension() == 2 && axes.find('z') != std::string::npos) {
    throw InputError("stage \"" + test.run.result.stages.back() + "\": " + key + " = \"" + axes +
                     "\" leaves the plane of a 2D specimen; allowed: x and y; change the " + key);
  }
}

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

std::size_t planned_records(const Protocol& protocol) {
  std::size_t count = 0;
  for (const Stage& stage : protocol.stages) {
    if (const auto* compression = std::get_if<CompressionStage>(&stage.what)) {
      count += record_strains(compression->to_strain, compression->record_every).size();
    } else if (const auto* shear = std::get_if<SimpleShearStage>(&stage.what)) {
      count += record_strains(shear->to_strain, shear->record_every).size();
    } else if (const auto* isotropic = std::get_if<IsotropicStage>(&stage.what)) {
      count += isotropic->record ? 2 : 0;
    } else if (const auto* relax = std::get_if<RelaxStage>(&stage.what)) {
      count += relax->record ? 2 : 0;
    }
  }
  return count;
}

void drive(RunningTest& test, const CompressionStage& stage) {
  const int dimension = test.dimension();
  const std::string axis_name = !stage.axis.empty() ? stage.axis : dimension == 2 ? "y" : "z";
  expect_axes(test, axis_name, "axis");
  const int axis = axis_index(axis_name[0]);
  const bool hold = stage.lateral == CompressionStage::Lateral::constant_stress;
  Progress& at = test.run.progress;
  at.axis = axis_name;
  at.pressure = hold ? stage.lateral_pressure : at.first_pressure;

  std::vector<HeldStress> held;
  for (int k = 0; k < dimension && hold; ++k) {
    if (k != axis) held.push_back({k, k, -stage.lateral_pressure, test.held_scale(stage.lateral_pressure)});
  }
  test.go_through(record_strains(stage.to_strain, stage.record_every), [&](double strain) {
    // From the accumulated F, so that round-off does not add up over a stage.
    const Matrix3& deformation = at.deformation;
    const double stretch = 1 - strain;
    const double lateral_stretch = dimension == 2 ? 1 / stretch : std::sqrt(1 / stretch);
    Matrix3 gradient = Matrix3::Zero();
    for (int k = 0; k < dimension; ++k) {
      if (k == axis) gradient(k, k) = stretch / deformation(k, k) - 1;
      if (k != axis && !hold) gradient(k, k) = lateral_stretch / deformation(k, k) - 1;
    }
    return test.apply(gradient, held, test.time_for(gradient(axis, axis)), test.loading.held_tolerance);
  });
}

void drive(RunningTest& test, const SimpleShearStage& stage) {
  const std::string plane = !stage.plane.empty() ? stage.plane : test.dimension() == 2 ? "xy" : "xz";
  expect_axes(test, plane, "plane");
  const int along = axis_index(plane[0]), normal = axis_index(plane[1]);
  const bool hold = stage.normal == SimpleShearStage::Normal::constant_stress;
  Progress& at = test.run.progress;
  at.axis = plane;
  at.pressure = hold ? stage.normal_pressure : at.first_pressure;

  std::vector<HeldStress> held;
  if (hold) held.push_back({normal, normal, -stage.normal_pressure, test.held_scale(stage.normal_pressure)});
  test.go_through(record_strains(stage.to_strain, stage.record_every), [&](double strain) {
    const Matrix3& deformation = at.deformation;
    Matrix3 gradient = Matrix3::Zero();
    gradient(along, normal) = (strain - deformation(along, normal)) / deformation(normal, normal);
    return test.apply(gradient, held, test.time_for(gradient(along, normal)), test.loading.held_tolerance);
  });
}

}  // namespace rvelab::protocol
