// Paths: constraints A : d eps + B : d sigma = c on strain and stress, with piecewise linear targets. Declared in
// stage_kinds.hpp.
#include <algorithm>

#include "rvelab/keys/key_builders.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/path_driven.hpp"
#include "rvelab/protocol/protocol_keys.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

PathRow read_row(const toml::table& table, const std::string& stage, std::size_t number, toml::array& resolved,
                 std::vector<keys::KeyError>& errors) {
  const std::string name = table["name"].value_or(std::to_string(number));
  TableReader reader(table, protocol_keys(), "stage.path.row", "stage." + stage + ".row." + name, line_of(table),
                     errors);
  PathRow row;
  row.name = reader.text("name");
  row.strain = reader.components("strain", true);
  row.stress = reader.components("stress", true);
  // B : sigma sums both halves of a shear: each has half of its factor.
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) row.stress(i, j) *= i == j ? 1 : 0.5;
  }
  const Matrix3 stiffness = reader.components("strain_Pa", true);
  const std::vector<double> strains = reader.numbers("to"), stresses = reader.numbers("to_Pa");
  row.to = row.in_stress() ? stresses : strains;
  if (row.in_stress() && !row.strain.isZero(0)) {
    reader.mistake("strain", "stands in a row with stress, whose unit is Pa; allowed there: strain_Pa; rename it");
  }
  if (row.in_stress()) row.strain = stiffness;
  if (!row.in_stress() && !stiffness.isZero(0)) {
    reader.mistake("strain_Pa", "stands in a row without stress; allowed: strain; rename it, or add stress");
  }
  if (!row.in_stress() && row.strain.isZero(0)) {
    reader.mistake("name", "has neither strain nor stress; allowed: at least one component that is not 0; add it");
  }
  if (row.in_stress() ? reader.has("to") : reader.has("to_Pa")) {
    reader.mistake(row.in_stress() ? "to" : "to_Pa",
                   row.in_stress() ? "has no unit in a row with stress; allowed: to_Pa; rename it"
                                   : "is no strain; allowed in a row without stress: to; rename it");
  }
  reader.finish();
  resolved.push_back(reader.resolved());
  return row;
}

struct Path : KindOf<PathStage> {
  const char* name() const override { return "path"; }

  std::vector<TableKey> keys() const override {
    const char *t = "stage.path", *r = "stage.path.row";
    const PathStage initial;
    return {
        required(listed(t, "row", "-", "list of tables", "[[stage.row]], at most 6", KeyKind::tables,
                        "constraints A : d eps + B : d sigma = c; a strain component that no row names stays zero")),
        whole_number(t, "records_per_point", initial.records_per_point, {1, 1e6},
                     "records, and increments, on the way to each point"),
        whole_number(t, "cycles", initial.cycles, {1, 1e6}, "number of times that the path passes through its points"),
        choice(t, "axis", {"x", "y", "z"}, "loading axis, kept in the record file", "(none)"),
        required(text(r, "name", "", "name of the row, for messages and --set stage.NAME.row.ROW.key=value")),
        listed(r, "strain", "1", "components", symmetric_components, KeyKind::components,
               "A of a row without stress, tension positive; yz, xz, xy: of the engineering shear strain"),
        listed(r, "stress", "1", "components", symmetric_components, KeyKind::components, "B, tension positive"),
        listed(r, "strain_Pa", "Pa", "components", symmetric_components, KeyKind::components,
               "A of a row with stress: a stiffness"),
        {{r, "to", "1", "list of numbers", "", "one number a point",
          "values of a row of strain, from 0 at the start of the stage; none: it stays 0"},
         KeyKind::numbers,
         every,
         {},
         {}},
        {{r, "to_Pa", "Pa", "list of numbers", "", "one number a point",
          "values of a row with stress; none: it keeps the value of the start of the stage"},
         KeyKind::numbers,
         every,
         {},
         {}},
    };
  }

  void read(StageSource& source) override {
    TableReader& reader = source.reader;
    const std::string& name = source.name;
    std::vector<keys::KeyError>& errors = source.errors;
    toml::array resolved;
    const auto tables = reader.tables("row");
    const std::size_t mistakes = errors.size();
    for (const toml::table* table : tables) {
      stage.rows.push_back(read_row(*table, name, stage.rows.size(), resolved, errors));
    }
    if (!tables.empty()) reader.resolve("row", resolved);
    stage.records_per_point = reader.whole_number("records_per_point");
    stage.cycles = reader.whole_number("cycles");
    stage.axis = reader.choice("axis", "");
    stage.points = 0;
    for (const PathRow& row : stage.rows) {
      const auto points = static_cast<long>(row.to.size());
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
    if (errors.size() > mistakes || stage.rows.empty()) return;
    if (stage.points == 0) {
      reader.mistake("row", "gives no targets; allowed: to or to_Pa in at least one row; add them");
      return;
    }
    if (static_cast<double>(stage.cycles) * stage.points * stage.records_per_point > most_records) {
      reader.mistake("records_per_point", "gives more than 1000000 records; allowed: at most so many; give fewer");
    }
    if (source.protocol.dimension == 0) return;  // looked at when the specimen is there
    const std::string mistake = mistake_of_rows(stage, source.protocol.dimension);
    if (!mistake.empty()) errors.push_back({line_of(*tables.front()), "stage." + name + ": " + mistake});
  }

  std::size_t planned_records() const override { return path_records(stage); }

  std::string misfit(int dimension) const override { return mistake_of_rows(stage, dimension); }

  void drive(RunningTest& test) const override { follow_path(test, stage); }
};

}  // namespace

std::unique_ptr<StageKind> path_kind() { return std::make_unique<Path>(); }

}  // namespace rvelab::protocol
