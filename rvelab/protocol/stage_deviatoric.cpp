// Deviatoric loading at constant mean stress, in 3D at a constant Lode angle. Declared in stage_kinds.hpp.
#include <cmath>

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/directions.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/path.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

PathStage path_of(const DeviatoricStage& stage, int dimension) {
  PathStage path;
  PathRow drive{"eps_q", Matrix3::Zero(), Matrix3::Zero(), {stage.to_strain}};
  // Held: no ramp from the p of the start.
  PathRow pressure{"p", Matrix3::Zero(), Matrix3::Zero(), {stage.pressure}, stage.pressure};
  for (int k = 0; k < dimension; ++k) pressure.stress(k, k) = -1.0 / dimension;
  path.records_per_point = std::max(1L, std::lround(stage.to_strain / stage.record_every));
  if (dimension == 2) {
    // e along (1, -1): eps_q = sqrt(2 e:e) = |e_xx - e_yy|
    drive.strain(0, 0) = 1;
    drive.strain(1, 1) = -1;
    path.axis = "y";
    path.rows = {drive, pressure};
    return path;
  }
  // Deviators, compression positive: axis k has cos(theta_k) with theta_z = theta, theta_x,y = theta -+ 120 degrees.
  PathRow across{"deviator across", Matrix3::Zero(), Matrix3::Zero(), {}};
  for (int k = 0; k < 3; ++k) {
    const double turn = stage.lode_angle_deg + (k == 0 ? -120 : k == 1 ? 120 : 0);
    const UnitVector direction = unit_vector(turn / 360);
    drive.strain(k, k) = -2.0 / 3 * direction.cosine;
    across.stress(k, k) = -2.0 / 3 * direction.sine;
  }
  path.axis = "z";
  path.rows = {drive, pressure, across};
  return path;
}

struct Deviatoric : KindOf<DeviatoricStage> {
  const char* name() const override { return "deviatoric"; }

  void read(TableReader& reader, Protocol& protocol) override {
    reader.required_number("to_strain", stage.to_strain, "1", positive, "eps_q at which the stage ends");
    read_spacing(reader, stage.record_every, stage.to_strain, "eps_q between records; at most 1e6 records");
    reader.number("lode_angle_deg", stage.lode_angle_deg, "degree", {-180, 180},
                  "3D: direction in the deviatoric plane; 0 compression along z, 60 extension along y");
    stage.pressure =
        pressure_of(reader, "pressure_Pa", held_pressures, "p, held constant; the stage must start from it", protocol);
    if (protocol.dimension == 2 && reader.has("lode_angle_deg"))
      reader.mistake("lode_angle_deg", "means nothing with test.dimension = 2; allowed: in 3D only; remove it");
  }

  std::string misfit(int dimension) const override {
    if (dimension == 3 || stage.lode_angle_deg == 0) return "";
    return "lode_angle_deg means nothing in 2D, and the specimen is 2D; remove it";
  }

  std::size_t planned_records() const override { return path_records(path_of(stage, 3)); }

  void drive(RunningTest& test) const override {
    const records::Progress& at = test.run.progress;
    if (at.step == 0) test.expect_consolidated("p", at.first_pressure, stage.pressure);
    follow_path(test, path_of(stage, test.dimension()));
  }
};

}  // namespace

std::unique_ptr<StageKind> deviatoric_kind() { return std::make_unique<Deviatoric>(); }

}  // namespace rvelab::protocol
