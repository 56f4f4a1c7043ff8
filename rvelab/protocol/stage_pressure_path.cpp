// Pressure paths: isotropic compression and swelling from pressure to pressure. Declared in stage_kinds.hpp.
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/path.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

/// The pressures as a path of one row for each normal stress.
PathStage path_of(const PressurePathStage& stage, int dimension) {
  PathStage path;
  path.points = long(stage.pressures.size());
  path.records_per_point = stage.records_per_point;
  path.isotropic = true;
  for (int k = 0; k < dimension; ++k) {
    PathRow row{std::string("pressure ") + "xyz"[k], Matrix3::Zero(), Matrix3::Zero(), stage.pressures};
    row.stress(k, k) = -1;
    path.rows.push_back(row);
  }
  return path;
}

struct PressurePath : KindOf<PressurePathStage> {
  const char* name() const override { return "pressure_path"; }

  void read(TableReader& reader, Protocol&) override {
    stage.pressures = reader.numbers(
        "to_Pa", "Pa", pressures,
        "pressures to which all normal stresses are brought, one after the other; shear strains are zero", nullptr,
        true);
    reader.whole_number("records_per_point", stage.records_per_point, {1, 1e6},
                        "records, and increments, on the way to each pressure");
  }

  std::size_t planned_records() const override { return path_records(path_of(stage, 2)); }

  void drive(RunningTest& test) const override { follow_path(test, path_of(stage, test.dimension())); }
};

}  // namespace

std::unique_ptr<StageKind> pressure_path_kind() { return std::make_unique<PressurePath>(); }

}  // namespace rvelab::protocol
