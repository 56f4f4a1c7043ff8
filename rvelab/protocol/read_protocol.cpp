// Reads a protocol, table by table. Declared in protocol.hpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/keys/assign.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/keys/toml_source.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/protocol_keys.hpp"
#include "rvelab/protocol/read_stage.hpp"
#include "rvelab/solver/assembly/specimen_check.hpp"

namespace rvelab::protocol {
namespace {

using keys::line_of;
using keys::table_of;
using keys::TableReader;

// [contact] before [material]: the law says which unit a stiffness has.
constexpr std::array<const char*, 4> override_tables{"contact", "damping", "solver", "material"};

void read_test(const toml::table& table, Protocol& protocol, toml::table& resolved,
               std::vector<keys::KeyError>& errors) {
  TableReader reader(table, protocol_keys(), "test", "test", line_of(table), errors);
  protocol.name = reader.text("name");
  protocol.dimension = static_cast<int>(reader.optional_whole_number("dimension").value_or(0));
  if (const auto pressure = reader.optional_number("pressure_Pa")) protocol.pressure = *pressure;
  // A pressure in another unit is one mistake, not one more for each stage that would have taken it.
  if (reader.has_in_another_unit("pressure_Pa") && std::isnan(protocol.pressure)) protocol.pressure = 0;
  reader.finish();
  resolved.insert("test", reader.resolved());
}

void read_loading(const toml::table& table, Protocol& protocol, toml::table& resolved,
                  std::vector<keys::KeyError>& errors) {
  TableReader reader(table, protocol_keys(), "loading", "loading", line_of(table), errors);
  LoadingSettings& loading = protocol.loading;
  loading.physical = reader.choice("mode") == "physical";
  const bool has_rate = reader.has("rate_1_s"), has_number = reader.has("inertial_number");
  loading.rate = reader.optional_number("rate_1_s").value_or(0);
  loading.inertial_number = reader.optional_number("inertial_number").value_or(0);
  if (has_rate && has_number) {
    reader.mistake("inertial_number", "contradicts loading.rate_1_s; allowed: one of the two; remove one");
  }
  if (!loading.physical && (has_rate || has_number)) {
    reader.mistake(has_rate ? "rate_1_s" : "inertial_number",
                   "contradicts loading.mode = \"quasi_static\", which has no rate; allowed: with mode = \"physical\" "
                   "only; set the mode or remove the key");
  }
  if (loading.physical && !has_rate && !has_number && !reader.has_in_another_unit("rate_1_s")) {
    reader.mistake("mode", "needs a rate; allowed: rate_1_s or inertial_number beside it; add one of them");
  }
  loading.held_tolerance = reader.number("held_tolerance");
  const bool usual_tolerance = loading.physical && !reader.has("held_tolerance");
  if (usual_tolerance) loading.held_tolerance = LoadingSettings::held_tolerance_at_rate;
  reader.finish();
  toml::table complete = reader.resolved();
  if (usual_tolerance) complete.insert_or_assign("held_tolerance", loading.held_tolerance);
  resolved.insert("loading", std::move(complete));
}

void read_specimen_name(const toml::table& file, Protocol& protocol, toml::table& resolved,
                        std::vector<keys::KeyError>& errors) {
  if (!file.contains("specimen")) return;
  TableReader reader(table_of(file, "specimen", errors), protocol_keys(), "specimen", "specimen",
                     line_of(*file.get("specimen")), errors);
  protocol.specimen_file = reader.text("file");
  reader.finish();
  resolved.insert("specimen", reader.resolved());
}

void read_calibrate(const toml::table& file, Protocol& protocol, toml::table& resolved,
                    std::vector<keys::KeyError>& errors) {
  if (!file.contains("calibrate")) return;
  TableReader reader(table_of(file, "calibrate", errors), protocol_keys(), "calibrate", "calibrate",
                     line_of(*file.get("calibrate")), errors);
  protocol.calibration_pressures = reader.numbers("pressures_Pa");
  reader.finish();
  resolved.insert("calibrate", reader.resolved());
}

void read_output(const toml::table& table, Protocol& protocol, toml::table& resolved,
                 std::vector<keys::KeyError>& errors) {
  TableReader reader(table, protocol_keys(), "output", "output", line_of(table), errors);
  protocol.snapshots_every = reader.whole_number("snapshots_every");
  const auto names = reader.choices("quantities");
  if (reader.has("quantities")) protocol.quantities = 0;
  for (const records::QuantityRow& row : records::quantity_rows) {
    if (std::find(names.begin(), names.end(), row.text.name) != names.end()) protocol.quantities |= row.bit;
  }
  reader.finish();
  resolved.insert("output", reader.resolved());
}

/// Checks the overrides on a specimen that has every material they name; how they fit the real one is seen when it is
/// there.
void check_overrides(const toml::table& file, std::vector<keys::KeyError>& errors) {
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
    if (const toml::table* table = file[name].as_table()) keys::read_table(any, name, *table, errors);
  }
}

/// `then` names stages that are there. `tables`: those that the stages were read from, one each.
void expect_followers(const Protocol& protocol, const std::vector<const toml::table*>& tables,
                      std::vector<keys::KeyError>& errors) {
  std::string known = "end";
  std::vector<std::string> names{"end"};
  for (const Stage& stage : protocol.stages) {
    known += ", " + stage.name;
    names.push_back(stage.name);
  }
  const auto expect = [&](const std::string& where, const std::string& then, const toml::node* place) {
    if (then.empty() || std::find(names.begin(), names.end(), then) != names.end()) return;
    const std::string message = where + ".then = \"" + then + "\" names no stage; allowed: " + known +
                                "; the nearest is " + keys::nearest(then, names) + "; correct the name";
    errors.push_back(keys::key_error(place->source(), message));
  };
  for (std::size_t s = 0; s < protocol.stages.size(); ++s) {
    const Stage& stage = protocol.stages[s];
    expect("stage." + stage.name, stage.then, tables[s]->get("then"));
    for (std::size_t k = 0; k < stage.until.size(); ++k) {
      const toml::table& until = *tables[s]->get("until")->as_array()->get(k)->as_table();
      expect("stage." + stage.name + ".until." + std::to_string(k), stage.until[k].then, until.get("then"));
    }
  }
}

void read_stages(const toml::table& file, Protocol& protocol, toml::table& resolved,
                 std::vector<keys::KeyError>& errors) {
  const toml::node* node = file.get("stage");
  const bool is_list = node != nullptr && node->is_array_of_tables() && !node->as_array()->empty();
  if (!is_list) {
    const std::string message =
        "the protocol has no stage; allowed: at least one [[stage]] with its keys below; add it";
    errors.push_back(node == nullptr ? keys::KeyError{0, message} : keys::key_error(node->source(), message));
    return;
  }
  toml::array stages;
  std::vector<const toml::table*> tables;
  long number = 0;
  for (const auto& stage : *node->as_array()) {
    read_stage(*stage.as_table(), number++, protocol, stages, errors);
    tables.resize(protocol.stages.size(), stage.as_table());  // one without a kind is no stage
  }
  resolved.insert("stage", stages);
  expect_followers(protocol, tables, errors);
}

Protocol read_file(toml::table file, const std::string& path, const std::vector<std::string>& assignments) {
  std::vector<keys::KeyError> errors;
  keys::assign_all(file, assignments, errors);
  Protocol protocol;
  protocol.path = path;
  toml::table resolved;
  keys::expect_top_tables(file, errors, top_tables());
  read_test(table_of(file, "test", errors), protocol, resolved, errors);
  read_loading(table_of(file, "loading", errors), protocol, resolved, errors);
  read_output(table_of(file, "output", errors), protocol, resolved, errors);
  read_specimen_name(file, protocol, resolved, errors);
  read_calibrate(file, protocol, resolved, errors);
  for (const char* name : override_tables) {
    if (!file.contains(name)) continue;
    const toml::table& overrides = table_of(file, name, errors);
    protocol.overrides.insert(name, overrides);
    resolved.insert(name, overrides);
  }
  check_overrides(file, errors);
  read_stages(file, protocol, resolved, errors);
  keys::raise(path, errors);

  std::ostringstream text;
  text << toml::toml_formatter{resolved} << "\n";
  protocol.resolved = text.str();
  return protocol;
}

}  // namespace

Protocol read_protocol(const std::string& path, const std::vector<std::string>& assignments) {
  return read_file(keys::parse_toml_file(path), path, assignments);
}

Protocol parse_protocol(const std::string& text, const std::string& path, const std::vector<std::string>& assignments) {
  return read_file(keys::parse_toml_text(text, path), path, assignments);
}

Specimen with_overrides(const Protocol& protocol, Specimen specimen) {
  if (protocol.dimension != 0 && protocol.dimension != specimen.cell.dimension) {
    throw InputError(protocol.path + ": the specimen has the dimension " + std::to_string(specimen.cell.dimension) +
                     "; allowed: test.dimension = " + std::to_string(protocol.dimension) +
                     "; give another specimen or another protocol");
  }
  std::vector<keys::KeyError> errors;
  for (const char* name : override_tables) {
    if (const toml::table* table = protocol.overrides[name].as_table())
      keys::read_table(specimen, name, *table, errors);
  }
  keys::raise(protocol.path, errors);
  expect_fits(protocol, specimen.cell.dimension);
  clear_forces_without_stiffness(specimen);  // a material that was given none here
  return specimen;
}

}  // namespace rvelab::protocol
