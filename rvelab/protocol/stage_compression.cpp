// Compression and extension: one axis is shortened, the others hold their stress, keep the volume or stay. Declared in
// stage_kinds.hpp.
#include <cmath>

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

struct Compression : KindOf<CompressionStage> {
  const char* name() const override { return "compression"; }
  const char* strength_when() const override { return "lateral = \"constant_stress\" and to_strain > 0"; }

  void read(TableReader& reader, Protocol& protocol) override {
    stage.axis = read_axes(reader, "axis", {"x", "y", "z"}, "laboratory axis that is shortened", "y", "z", protocol);
    read_strain(reader, stage.to_strain, {-infinity, 1, true, true},
                "strain 1 - F_aa at which the stage ends, compression positive", "below 1, not 0");
    read_spacing(reader, stage.record_every, stage.to_strain, "strain between records; at most 1e6 records");
    const Choices laterals{"constant_stress", "constant_volume", "zero_strain"};
    reader.choice("lateral", stage.lateral, laterals,
                  "constant_stress: each lateral normal stress is held (drained); constant_volume: det F = 1 "
                  "(undrained); zero_strain: oedometer");
    const bool held = stage.lateral == CompressionStage::Lateral::constant_stress;
    stage.lateral_pressure =
        pressure_of(reader, "lateral_pressure_Pa", held_pressures_from_zero,
                    "lateral = constant_stress: lateral stress that is held, compression positive; the stage must "
                    "start from it; 0: "
                    "of bonded grains",
                    protocol, held ? "" : "lateral = " + as_toml(laterals[std::size_t(stage.lateral)]));
    read_cycles(
        reader, stage.cycles, stage.to_strain, stage.record_every,
        "cycles > 0: the strain reverses where the size of the axial less the mean lateral stress reaches this");
  }

  std::size_t planned_records() const override {
    return strain_records(stage.to_strain, stage.record_every, stage.cycles);
  }

  std::string misfit(int dimension) const override { return out_of_plane("axis", stage.axis, dimension); }

  StageRole role() const override {
    using Lateral = CompressionStage::Lateral;
    if (stage.lateral == Lateral::zero_strain) return {StageRole::Gives::oedometric_stiffness, stage.axis};
    if (stage.lateral == Lateral::constant_stress && stage.to_strain > 0)
      return {StageRole::Gives::strength, stage.axis};
    return {};
  }

  void drive(RunningTest& test) const override {
    const int dimension = test.dimension();
    const std::string axis_name = !stage.axis.empty() ? stage.axis : dimension == 2 ? "y" : "z";
    const int axis = axis_index(axis_name[0]);
    const bool hold = stage.lateral == CompressionStage::Lateral::constant_stress;
    const bool undrained = stage.lateral == CompressionStage::Lateral::constant_volume;
    records::Progress& at = test.run.progress;
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
    drive_strain(test, stage, increment_to, [&](const Matrix3& stress) {
      double axial_less_lateral = -stress(axis, axis);
      for (int k = 0; k < dimension; ++k) {
        if (k != axis) axial_less_lateral += stress(k, k) / (dimension - 1);
      }
      return axial_less_lateral;
    });
  }
};

}  // namespace

std::unique_ptr<StageKind> compression_kind() { return std::make_unique<Compression>(); }

}  // namespace rvelab::protocol
