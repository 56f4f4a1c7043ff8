#include <array>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/read_stage.hpp"
#include "rvelab/protocol/table_reader.hpp"

namespace rvelab {
namespace {

using protocol::line_of;
using protocol::TableReader;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr io::Range positive{0, infinity, true, true};
// [contact] before [material]: the law says which unit a stiffness has.
constexpr std::array<const char*, 4> override_tables{"contact", "damping", "solver", "material"};

/// A table of the file; an empty one where there is none, a mistake where it is something else.
const toml::table& table_of(const toml::table& file, const std::string& name, std::vector<KeyError>& errors) {
  static const toml::table nothing;
  const toml::node* node = file.get(name);
  if (node == nullptr) return nothing;
  if (node->is_table()) return *node->as_table();
  errors.push_back(
      {line_of(*node), name + " is not a table; allowed: [" + name + "] with its keys below; write it so"});
  return nothing;
}

void read_test(const toml::table& table, Protocol& protocol, toml::table& resolved, std::vector<KeyError>& errors) {
  TableReader reader(table, "test", line_of(table), errors);
  protocol.name = reader.text("name", std::nullopt);
  if (reader.has("dimension")) {
    const long dimension = reader.whole_number("dimension", 0, {2, 3});
    protocol.dimension = dimension == 2 || dimension == 3 ? static_cast<int>(dimension) : 0;
  }
  reader.know("dimension");
  if (reader.has("pressure_Pa")) protocol.pressure = reader.number("pressure_Pa", std::nullopt, positive);
  reader.know("pressure_Pa");
  reader.finish();
  resolved.insert("test", reader.resolved());
}

void read_loading(const toml::table& table, Protocol& protocol, toml::table& resolved, std::vector<KeyError>& errors) {
  TableReader reader(table, "loading", line_of(table), errors);
  Loading& loading = protocol.loading;
  loading.physical = reader.word("mode", "quasi_static", {"quasi_static", "physical"}) == "physical";
  const bool has_rate = reader.has("rate_1_s"), has_number = reader.has("inertial_number");
  if (has_rate) loading.rate = reader.number("rate_1_s", std::nullopt, positive);
  if (has_number) loading.inertial_number = reader.number("inertial_number", std::nullopt, positive);
  reader.know("rate_1_s");
  reader.know("inertial_number");
  if (has_rate && has_number) {
    reader.mistake("inertial_number", "contradicts loading.rate_1_s; allowed: one of the two; remove one");
  }
  if (!loading.physical && (has_rate || has_number)) {
    reader.mistake(has_rate ? "rate_1_s" : "inertial_number",
                   "contradicts loading.mode = \"quasi_static\", which has no rate; allowed: with mode = \"physical\" "
                   "only; set the mode or remove the key");
  }
  if (loading.physical && !has_rate && !has_number) {
    reader.mistake("mode", "needs a rate; allowed: rate_1_s or inertial_number beside it; add one of them");
  }
  loading.held_tolerance = reader.number("held_tolerance", loading.held_tolerance, {0, 1, true, true});
  loading.held_wait = reader.whole_number("held_wait", loading.held_wait, {0, 1e9});
  reader.finish();
  resolved.insert("loading", reader.resolved());
}

void read_output(const toml::table& table, Protocol& protocol, toml::table& resolved, std::vector<KeyError>& errors) {
  TableReader reader(table, "output", line_of(table), errors);
  protocol.snapshots_every = reader.whole_number("snapshots_every", protocol.snapshots_every, {0, 1e9});
  reader.finish();
  resolved.insert("output", reader.resolved());
}

/// Checks the overrides on a specimen that has every material they name; how they fit the real one is seen when it is
/// there.
void check_overrides(const toml::table& file, std::vector<KeyError>& errors) {
  Specimen any;
  any.materials.emplace_back();
  if (const toml::table* materials = file["material"].as_table()) {
    for (const auto& [key, value] : *materials) {
      if (!value.is_table()) continue;
      any.materials.emplace_back();
      any.materials.back().name = std::string(key.str());
    }
  }
  for (const char* name : override_tables) {
    if (const toml::table* table = file[name].as_table()) read_table(any, name, *table, errors);
  }
}

void read_stages(const toml::table& file, Protocol& protocol, toml::table& resolved, std::vector<KeyError>& errors) {
  const toml::node* node = file.get("stage");
  const bool is_list = node != nullptr && node->is_array_of_tables() && !node->as_array()->empty();
  if (!is_list) {
    errors.push_back({node == nullptr ? 0 : line_of(*node),
                      "the protocol has no stage; allowed: at least one [[stage]] with its keys below; add it"});
    return;
  }
  toml::array stages;
  long number = 0;
  for (const auto& stage : *node->as_array()) {
    protocol::read_stage(*stage.as_table(), number++, protocol, stages, errors);
  }
  resolved.insert("stage", stages);
}

Protocol read_file(toml::table file, const std::string& path, const std::vector<std::string>& assignments) {
  for (const auto& assignment : assignments) assign(file, assignment);
  Protocol protocol;
  protocol.path = path;
  std::vector<KeyError> errors;
  toml::table resolved;

  TableReader top(file, "", 0, errors);
  for (const char* name : {"test", "specimen", "loading", "output", "stage", "calibrate"}) top.know(name);
  for (const char* name : override_tables) top.know(name);
  top.finish();

  read_test(table_of(file, "test", errors), protocol, resolved, errors);
  read_loading(table_of(file, "loading", errors), protocol, resolved, errors);
  read_output(table_of(file, "output", errors), protocol, resolved, errors);
  if (file.contains("specimen")) {
    TableReader reader(table_of(file, "specimen", errors), "specimen", line_of(*file.get("specimen")), errors);
    protocol.specimen_file = reader.text("file", std::nullopt);
    reader.finish();
    resolved.insert("specimen", reader.resolved());
  }
  if (file.contains("calibrate")) {
    TableReader reader(table_of(file, "calibrate", errors), "calibrate", line_of(*file.get("calibrate")), errors);
    protocol.calibration_pressures = reader.numbers("pressures_Pa", positive);
    reader.finish();
    resolved.insert("calibrate", reader.resolved());
  }
  for (const char* name : override_tables) {
    if (!file.contains(name)) continue;
    const toml::table& overrides = table_of(file, name, errors);
    protocol.overrides.insert(name, overrides);
    resolved.insert(name, overrides);
  }
  check_overrides(file, errors);
  read_stages(file, protocol, resolved, errors);
  raise(path, errors);

  std::ostringstream text;
  text << toml::toml_formatter{resolved} << "\n";
  protocol.resolved = text.str();
  return protocol;
}

}  // namespace

Protocol read_protocol(const std::string& path, const std::vector<std::string>& assignments) {
  return read_file(parse_toml_file(path), path, assignments);
}

Protocol parse_protocol(const std::string& text, const std::string& path, const std::vector<std::string>& assignments) {
  try {
    return read_file(toml::parse(text), path, assignments);
  } catch (const toml::parse_error& error) {
    throw InputError(path + ":" + std::to_string(error.source().begin.line) + ": is not TOML (" +
                     std::string(error.description()) + "); correct the line");
  }
}

Specimen with_overrides(const Protocol& protocol, Specimen specimen) {
  if (protocol.dimension != 0 && protocol.dimension != specimen.cell.dimension) {
    throw InputError(protocol.path + ": the specimen has the dimension " + std::to_string(specimen.cell.dimension) +
                     "; allowed: test.dimension = " + std::to_string(protocol.dimension) +
                     "; give another specimen or another protocol");
  }
  std::vector<KeyError> errors;
  for (const char* name : override_tables) {
    if (const toml::table* table = protocol.overrides[name].as_table()) read_table(specimen, name, *table, errors);
  }
  raise(protocol.path, errors);
  return specimen;
}

}  // namespace rvelab
