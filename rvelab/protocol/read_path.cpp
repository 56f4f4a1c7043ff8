// Stages that follow rows, flows and lists, and the events of all.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/protocol/path_rows.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {

/// A stage's own pressure, or the test's.
double pressure_of(TableReader& reader, const std::string& name, Protocol& protocol) {
  if (reader.has(name)) return reader.number(name);
  const bool nowhere = std::isnan(protocol.pressure);
  if (nowhere && !reader.has_in_another_unit(name)) {
    reader.mistake(name, "is missing, and so is test.pressure_Pa; allowed: > 0 Pa; add one of them");
  }
  protocol.uses_pressure = protocol.uses_pressure || !nowhere;
  return reader.number(name, nowhere ? 0 : protocol.pressure);
}

/// A pressure that the stage holds nothing at.
void refuse_pressure(TableReader& reader, const std::string& name, const std::string& other) {
  reader.leave(name);
  if (reader.has(name)) reader.mistake(name, "contradicts " + other + "; allowed: one of the two; remove one");
}

double spacing_of(TableReader& reader, double to_strain) {
  const double spacing = reader.number("record_every");
  if (std::abs(to_strain) / spacing > most_records) {
    reader.mistake("record_every", "gives " + std::to_string(std::abs(to_strain) / spacing) +
                                       " records; allowed: at most 1000000; give a larger spacing");
  }
  return spacing;
}

namespace {

PathRow read_row(const toml::table& table, const std::string& stage, std::size_t number, toml::array& resolved,
                 std::vector<KeyError>& errors) {
  const std::string name = table["name"].value_or(std::to_string(number));
  TableReader reader(table, "stage.path.row", "stage." + stage + ".row." + name, line_of(table), errors);
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

/// In 2D nothing moves along z.
void expect_plane(TableReader& reader, const std::string& key, const Matrix3& f, const Protocol& protocol) {
  Matrix3 out = f;
  out.topLeftCorner<2, 2>().setZero();
  if (protocol.dimension == 2 && !out.isZero(0)) {
    reader.mistake(key, "leaves the plane of test.dimension = 2; allowed: xx, xy, yx, yy; remove the others");
  }
}

}  // namespace

DeviatoricStage read_deviatoric(TableReader& reader, Protocol& protocol) {
  DeviatoricStage stage;
  stage.to_strain = reader.number("to_strain");
  stage.record_every = spacing_of(reader, stage.to_strain);
  stage.lode_angle_deg = reader.number("lode_angle_deg");
  stage.pressure = pressure_of(reader, "pressure_Pa", protocol);
  if (protocol.dimension == 2 && reader.has("lode_angle_deg")) {
    reader.mistake("lode_angle_deg", "means nothing with test.dimension = 2; allowed: in 3D only; remove it");
  }
  return stage;
}

PressurePathStage read_pressure_path(TableReader& reader) {
  PressurePathStage stage;
  stage.pressures = reader.numbers("to_Pa");
  if (stage.pressures.empty() && !reader.has("to_Pa") && !reader.has_in_another_unit("to_Pa")) {
    reader.mistake("to_Pa", "is missing; allowed: each > 0 Pa; add it");
  }
  stage.records_per_point = reader.whole_number("records_per_point");
  return stage;
}

PathStage read_path(TableReader& reader, const std::string& name, const Protocol& protocol,
                    std::vector<KeyError>& errors) {
  PathStage stage;
  toml::array resolved;
  const auto tables = reader.tables("row");
  const std::size_t mistakes = errors.size();
  for (const toml::table* table : tables) {
    stage.rows.push_back(read_row(*table, name, stage.rows.size(), resolved, errors));
  }
  if (!tables.empty()) reader.resolve("row", resolved);
  stage.records_per_point = reader.whole_number("records_per_point");
  stage.cycles = reader.whole_number("cycles");
  stage.axis = reader.word("axis", "");
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
  if (errors.size() > mistakes || stage.rows.empty()) return stage;
  if (stage.points == 0) {
    reader.mistake("row", "gives no targets; allowed: to or to_Pa in at least one row; add them");
    return stage;
  }
  if (static_cast<double>(stage.cycles) * stage.points * stage.records_per_point > most_records) {
    reader.mistake("records_per_point", "gives more than 1000000 records; allowed: at most so many; give fewer");
  }
  if (protocol.dimension == 0) return stage;  // looked at when the specimen is there
  const std::string mistake = mistake_of_rows(stage, protocol.dimension);
  if (!mistake.empty()) errors.push_back({line_of(*tables.front()), "stage." + name + ": " + mistake});
  return stage;
}

FlowStage read_flow(TableReader& reader, const Protocol& protocol) {
  FlowStage stage;
  stage.gradient = reader.components("gradient", false);
  expect_plane(reader, "gradient", stage.gradient, protocol);
  stage.to_strain = reader.number("to_strain");
  stage.record_every = spacing_of(reader, stage.to_strain);
  return stage;
}

DeformationStage read_deformation(TableReader& reader, const Protocol& protocol) {
  DeformationStage stage;
  stage.gradients = reader.matrices("gradients");
  for (const Matrix3& f : stage.gradients) {
    if (f.determinant() <= 0) {
      reader.mistake("gradients", "has a determinant <= 0; allowed: > 0; correct it");
      break;
    }
    Matrix3 out = f - Matrix3::Identity();
    out.topLeftCorner<2, 2>().setZero();
    if (protocol.dimension == 2 && !out.isZero(0)) {
      reader.mistake("gradients", "leave the plane of test.dimension = 2; allowed: 4 numbers each; correct them");
      break;
    }
  }
  return stage;
}

EnvelopeStage read_envelope(TableReader& reader) {
  EnvelopeStage stage;
  stage.stress_probes = reader.word("probes") == "stress";
  stage.size = reader.number("size");
  stage.stress_size = reader.optional_number("size_Pa").value_or(0);
  if (stage.stress_probes && !reader.has("size_Pa") && !reader.has_in_another_unit("size_Pa")) {
    reader.mistake("size_Pa", "is missing; allowed with probes = \"stress\": > 0 Pa; add it");
  }
  if (reader.has(stage.stress_probes ? "size" : "size_Pa")) {
    reader.mistake(stage.stress_probes ? "size" : "size_Pa", std::string("contradicts probes = \"") +
                                                                 (stage.stress_probes ? "stress" : "strain") +
                                                                 "\"; allowed: the size of these only; remove it");
  }
  stage.directions = reader.whole_number("directions");
  stage.increments = reader.whole_number("increments");
  stage.unbalanced = reader.number("unbalanced");
  stage.max_steps = reader.whole_number("max_steps");
  return stage;
}

std::vector<Event> read_until(TableReader& reader, const std::string& stage, const std::string& kind,
                              std::vector<KeyError>& errors) {
  std::vector<Event> events;
  toml::array resolved;
  for (const toml::table* table : reader.tables("until")) {
    TableReader until(*table, "stage.until", "stage." + stage + ".until." + std::to_string(events.size()),
                      line_of(*table), errors);
    Event event;
    event.quantity = until.word("quantity");
    const auto above = until.optional_number("above"), below = until.optional_number("below"),
               falls_by = until.optional_number("falls_by");
    if (above) event = {event.quantity, Event::When::above, *above, ""};
    if (below) event = {event.quantity, Event::When::below, *below, ""};
    if (falls_by) event = {event.quantity, Event::When::falls_by, *falls_by, ""};
    if (int(above.has_value()) + int(below.has_value()) + int(falls_by.has_value()) != 1) {
      until.mistake("quantity", "needs one of above, below, falls_by; allowed: exactly one; give one");
    }
    event.then = until.text("then", "");
    until.finish();
    resolved.push_back(until.resolved());
    events.push_back(event);
  }
  if (events.empty()) return events;
  reader.resolve("until", resolved);
  if (kind == "isotropic" || kind == "relax" || kind == "probe" || kind == "envelope") {
    reader.mistake("until", "has no records to look at in kind = \"" + kind +
                                "\"; allowed: with compression, simple_shear, deviatoric, path, flow, deformation; "
                                "remove it");
  }
  return events;
}

}  // namespace rvelab::protocol
