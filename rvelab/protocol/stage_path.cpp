// Paths: constraints A : d eps + B : d sigma = c on strain and stress, with piecewise linear targets. Declared in
// stage_kinds.hpp.
#include <algorithm>

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/path.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

PathRow read_row(TableReader& reader) {
  PathRow row;
  row.name = reader.required_text("name", "name of the row, for messages and --set stage.NAME.row.ROW.key=value");
  row.strain = reader.components(
      "strain", "1", "A of a row without stress, tension positive; yz, xz, xy: of the engineering shear strain", true);
  row.stress = reader.components("stress", "1", "B, tension positive", true);
  // B : sigma sums both halves of a shear: each has half of its factor.
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) row.stress(i, j) *= i == j ? 1 : 0.5;
  }
  const Matrix3 stiffness = reader.components("strain_Pa", "Pa", "A of a row with stress: a stiffness", true);
  const auto strains =
      reader.numbers("to", "1", every, "values of a row of strain, from 0 at the start of the stage; none: it stays 0",
                     "one number a point");
  const auto stresses = reader.numbers(
      "to_Pa", "Pa", every, "values of a row with stress; none: it keeps the value of the start of the stage",
      "one number a point");
  row.to = row.in_stress() ? stresses : strains;
  if (row.in_stress()) {
    if (!row.strain.isZero(0))
      reader.mistake("strain", "stands in a row with stress, whose unit is Pa; allowed there: strain_Pa; rename it");
    row.strain = stiffness;
    if (reader.has("to")) reader.mistake("to", "has no unit in a row with stress; allowed: to_Pa; rename it");
    return row;
  }
  if (!stiffness.isZero(0))
    reader.mistake("strain_Pa", "stands in a row without stress; allowed: strain; rename it, or add stress");
  if (row.strain.isZero(0))
    reader.mistake("name", "has neither strain nor stress; allowed: at least one component that is not 0; add it");
  if (reader.has("to_Pa")) reader.mistake("to_Pa", "is no strain; allowed in a row without stress: to; rename it");
  return row;
}

struct Path : KindOf<PathStage> {
  const char* name() const override { return "path"; }

  void read(TableReader& reader, Protocol& protocol) override {
    const std::size_t mistakes = reader.mistakes();
    stage.rows = reader.tables(
        "row", "stage.path.row", true, "[[stage.row]], at most 6",
        "constraints A : d eps + B : d sigma = c; a strain component that no row names stays zero", read_row);
    reader.whole_number("records_per_point", stage.records_per_point, {1, 1e6},
                        "records, and increments, on the way to each point");
    reader.whole_number("cycles", stage.cycles, {1, 1e6}, "number of times that the path passes through its points");
    stage.axis = reader.choice("axis", "", {"x", "y", "z"}, "loading axis, kept in the record file", "(none)");
    check_points(reader);
    if (reader.mistakes() > mistakes || stage.rows.empty()) return;
    if (stage.points == 0) {
      reader.mistake("row", "gives no targets; allowed: to or to_Pa in at least one row; add them");
      return;
    }
    if (double(stage.cycles) * stage.points * stage.records_per_point > most_records) {
      reader.mistake("records_per_point", "gives more than 1000000 records; allowed: at most so many; give fewer");
    }
    if (protocol.dimension == 0) return;  // checked when the specimen is there
    const std::string mistake = mistake_of_rows(stage, protocol.dimension);
    if (!mistake.empty()) reader.mistake_in("row", mistake);
  }

  /// Rows have as many points as each other, or none, and names of their own.
  void check_points(TableReader& reader) {
    stage.points = 0;
    for (const PathRow& row : stage.rows) {
      const auto points = long(row.to.size());
      if (points > 0 && stage.points > 0 && points != stage.points) {
        reader.mistake("row", "\"" + row.name + "\" has " + std::to_string(points) + " points and a row before it " +
                                  std::to_string(stage.points) + "; allowed: the same number in all that have any");
      }
      stage.points = std::max(stage.points, points);
      const auto same = [&](const PathRow& other) { return &other != &row && other.name == row.name; };
      if (std::any_of(stage.rows.begin(), stage.rows.end(), same) && &row == &stage.rows.back()) {
        reader.mistake("row", "\"" + row.name + "\" is there twice; allowed: a name of its own for each; rename it");
      }
    }
  }

  std::size_t planned_records() const override { return path_records(stage); }

  std::string misfit(int dimension) const override { return mistake_of_rows(stage, dimension); }

  void drive(RunningTest& test) const override { follow_path(test, stage); }
};

}  // namespace

std::unique_ptr<StageKind> path_kind() { return std::make_unique<Path>(); }

}  // namespace rvelab::protocol
