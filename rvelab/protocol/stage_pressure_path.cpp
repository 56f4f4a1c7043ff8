// Pressure paths: isotropic compression and swelling from pressure to pressure. Declared in stage_kinds.hpp.
#include "rvelab/keys/key_builders.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/path_driven.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

/// The pressures as a path of one row for each normal stress.
PathStage path_of(const PressurePathStage& stage, int dimension) {
  PathStage path;
  path.points = static_cast<long>(stage.pressures.size());
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

  std::vector<TableKey> keys() const override {
    const char* t = "stage.pressure_path";
    TableKey targets =
        listed(t, "to_Pa", "Pa", "list of numbers", "", KeyKind::numbers,
               "pressures to which all normal stresses are brought, one after the other; shear strains are zero");
    targets.range = pressures;
    targets.key.range = "each " + in_words(pressures);
    return {required(targets), whole_number(t, "records_per_point", PressurePathStage{}.records_per_point, {1, 1e6},
                                            "records, and increments, on the way to each pressure")};
  }

  void read(StageSource& source) override {
    TableReader& reader = source.reader;
    stage.pressures = reader.numbers("to_Pa");
    if (stage.pressures.empty() && !reader.has("to_Pa") && !reader.has_in_another_unit("to_Pa")) {
      reader.mistake("to_Pa", "is missing; allowed: each " + in_words(pressures) + " Pa; add it");
    }
    stage.records_per_point = reader.whole_number("records_per_point");
  }

  std::size_t planned_records() const override { return path_records(path_of(stage, 2)); }

  void drive(RunningTest& test) const override { follow_path(test, path_of(stage, test.dimension())); }
};

}  // namespace

std::unique_ptr<StageKind> pressure_path_kind() { return std::make_unique<PressurePath>(); }

}  // namespace rvelab::protocol
