// Simple shear in a plane, at constant volume or constant normal stress. Declared in stage_kinds.hpp.
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

struct SimpleShear : KindOf<SimpleShearStage> {
  const char* name() const override { return "simple_shear"; }
  const char* strength_when() const override { return "normal = \"constant_stress\" and without cycles"; }

  StageRole role() const override {
    const bool drained = stage.normal == SimpleShearStage::Normal::constant_stress && stage.cycles.count == 0;
    return drained ? StageRole{StageRole::Gives::strength, ""} : StageRole{};
  }

  void read(TableReader& reader, Protocol& protocol) override {
    stage.plane =
        read_axes(reader, "plane", {"xy", "xz", "yz", "yx", "zx", "zy"}, "ab: shear dv_a/dx_b", "xy", "xz", protocol);
    read_strain(reader, stage.to_strain, every, "gamma = F_ab at which the stage ends, either sign",
                "any finite number but 0");
    read_spacing(reader, stage.record_every, stage.to_strain, "gamma between records; at most 1e6 records");
    reader.choice("normal", stage.normal, {"constant_volume", "constant_stress"},
                  "constant_volume: only the shear moves (undrained); constant_stress: sigma_bb is held (drained)");
    const bool held = stage.normal == SimpleShearStage::Normal::constant_stress;
    stage.normal_pressure = pressure_of(
        reader, "normal_pressure_Pa", held_pressures,
        "normal = constant_stress: normal stress that is held, compression positive; the stage must start from it",
        protocol, held ? "" : "normal = \"constant_volume\"");
    read_cycles(reader, stage.cycles, stage.to_strain, stage.record_every,
                "cycles > 0: gamma reverses where the size of sigma_ab reaches this");
  }

  std::size_t planned_records() const override {
    return strain_records(stage.to_strain, stage.record_every, stage.cycles);
  }

  std::string misfit(int dimension) const override { return out_of_plane("plane", stage.plane, dimension); }

  void drive(RunningTest& test) const override {
    const std::string plane = !stage.plane.empty() ? stage.plane : test.dimension() == 2 ? "xy" : "xz";
    const int along = axis_index(plane[0]), normal = axis_index(plane[1]);
    const bool hold = stage.normal == SimpleShearStage::Normal::constant_stress;
    records::Progress& at = test.run.progress;
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
    drive_strain(test, stage, increment_to,
                 [&](const Matrix3& stress) { return 0.5 * (stress(along, normal) + stress(normal, along)); });
  }
};

}  // namespace

std::unique_ptr<StageKind> simple_shear_kind() { return std::make_unique<SimpleShear>(); }

}  // namespace rvelab::protocol
