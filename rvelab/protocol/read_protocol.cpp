// Reads a protocol, table by table. Declared in protocol.hpp.
#include <algorithm>
#include <array>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/pack/plausible.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/specimen/specimen_check.hpp"

namespace rvelab::protocol {

namespace {

using namespace keys;

constexpr const char* pressure_words = "the largest pressure of the test, in Pa,";

// [contact] before [material]: the law says which unit a stiffness has.
constexpr std::array<const char*, 4> override_tables{"contact", "damping", "solver", "material"};

void read_test(TableReader& reader, Protocol& protocol) {
  protocol.name = reader.required_text("name", "name of the test, kept in the record file");
  const auto dimension =
      reader.optional_whole_number("dimension", {2, 3}, "dimension of the specimen", "(that of the specimen)", "2, 3");
  protocol.dimension = int(dimension.value_or(0));
  const auto pressure = reader.optional_number(
      "pressure_Pa", "Pa", pressures_from_zero,
      "pressure, compression positive, of every stage without one of its own; `rvelab calibrate` sets it");
  protocol.pressure = pressure.value_or(protocol.pressure);
  // A pressure that is wrong, or in another unit, is one mistake, not one more for each stage that would have taken it.
  const bool meant = reader.has("pressure_Pa") || reader.has_in_another_unit("pressure_Pa");
  if (meant && std::isnan(protocol.pressure)) protocol.pressure = 0;
}

void read_loading(TableReader& reader, Protocol& protocol) {
  LoadingSettings& loading = protocol.loading;
  reader.choice(
      "mode", loading.at_rate, {"quasi_static", "at_rate"},
      "time in compression, simple shear, flow and deformation: quasi_static, or at_rate with physical masses at "
      "the given rate");
  const auto rate =
      reader.optional_number("rate_1_s", "1/s", positive, "mode = at_rate: true rate of the driving strain");
  const auto inertial_number = reader.optional_number(
      "inertial_number", "1", positive,
      "mode = at_rate, in place of rate_1_s: I = rate d sqrt(rho/p) with p at the start of the stage");
  const bool has_rate = reader.has("rate_1_s"), has_number = reader.has("inertial_number");
  loading.rate = rate.value_or(0);
  loading.inertial_number = inertial_number.value_or(0);
  if (has_rate && has_number)
    reader.mistake("inertial_number", "contradicts loading.rate_1_s; allowed: one of the two; remove one");
  if (!loading.at_rate)
    reader.refuse(has_rate ? "rate_1_s" : "inertial_number",
                  "contradicts loading.mode = \"quasi_static\", which has no rate; allowed: with mode = \"at_rate\" "
                  "only; set the mode or remove the key");
  if (loading.at_rate && !has_rate && !has_number && !reader.has_in_another_unit("rate_1_s"))
    reader.mistake("mode", "needs a rate; allowed: rate_1_s or inertial_number beside it; add one of them");
  reader.number("held_tolerance", loading.held_tolerance, "1", ratio,
                "allowed error of a held stress, over the larger of its target and 1 % of p at the start of the stage; "
                "mode = at_rate: of its mean over an increment, by default 0.05");
  if (!loading.at_rate || reader.has("held_tolerance")) return;
  loading.held_tolerance = LoadingSettings::held_tolerance_at_rate;
  reader.resolve("held_tolerance", loading.held_tolerance);
}

void read_output(TableReader& reader, Protocol& protocol) {
  reader.whole_number("snapshots_every", protocol.snapshots_every, {0, 1e9},
                      "n: the file keeps grains and contacts of every n-th record, from the first; 0: of none");
  Choices all;
  std::string usual;
  for (const records::QuantityRow& row : records::quantity_rows) {
    all.emplace_back(row.text.name);
    if (row.text.usual) usual += (usual.empty() ? "[" : ", ") + as_toml(all.back());
  }
  const auto names = reader.choices(
      "quantities", all, "quantities measured at each record beside strain and stress; others are not computed",
      usual + "]");
  if (reader.has("quantities")) protocol.quantities = 0;
  for (const records::QuantityRow& row : records::quantity_rows)
    if (std::find(names.begin(), names.end(), row.text.name) != names.end()) protocol.quantities |= row.bit;
}

void read_specimen_name(TableReader& reader, Protocol& protocol) {
  protocol.specimen_file = reader.required_text(
      "file", "specimen file of the test, relative to the protocol's folder; --specimen overrides it");
}

void read_calibrate(TableReader& reader, Protocol& protocol) {
  protocol.calibration_pressures = reader.numbers("pressures_Pa", "Pa", held_pressures_from_zero,
                                                  "pressures of `rvelab calibrate`; --pressures overrides them");
}

/// The tables of a protocol beside its stages, in the order of the documentation.
struct TableOfProtocol {
  const char* name;
  void (*read)(TableReader&, Protocol&);
  bool optional = false;
};
constexpr TableOfProtocol tables_of_protocol[] = {{"test", read_test},
                                                  {"loading", read_loading},
                                                  {"output", read_output},
                                                  {"specimen", read_specimen_name, true},
                                                  {"calibrate", read_calibrate, true}};

std::string read_kind(TableReader& reader) {
  Choices kinds;
  for (MakeStage* const make : stage_kinds) kinds.emplace_back(make()->name());
  return reader.required_choice("kind", kinds,
                                "kind of loading; the other keys of the stage are those listed under its kind");
}

/// What stages of every kind have.
void read_common(TableReader& reader, Stage& stage) {
  reader.text("name", stage.name, "name of the stage, in records and in --set stage.NAME.key=value", "(its kind)");
  reader.text("then", stage.then, "name of the stage that follows, \"end\" for none", "(the next)");
  stage.until = read_events(reader);
}

/// The largest of the pressures that a stage brings its grains to, Pa.
double largest_pressure(const TableReader& reader) {
  double largest = 0;
  for (const Key& key : reader.keys()) {
    if (key.unit != "Pa" || key.usual.values.low != pressures.usual.values.low) continue;
    const toml::node* node = reader.resolved().get(key.name);
    if (node == nullptr) continue;
    if (node->is_number()) largest = std::max(largest, number_in(*node));
    if (const toml::array* list = node->as_array())
      for (const auto& each : *list)
        if (each.is_number()) largest = std::max(largest, number_in(each));
  }
  return largest;
}

void read_stage(const toml::table& table, long number, Protocol& protocol, toml::array& resolved,
                std::vector<KeyError>& errors) {
  const std::string kind_given = table["kind"].value_or(std::string());
  const std::string name = table["name"].value_or(kind_given.empty() ? std::to_string(number) : kind_given);
  TableReader reader(table, "stage", "stage." + name, line_of(table), errors);
  Stage stage;
  stage.kind = stage.name = read_kind(reader);
  if (stage.kind.empty()) return;  // without its kind no other key can be judged
  read_common(reader, stage);
  auto what = stage_of_kind(stage.kind);
  what->read(reader, protocol);
  protocol.largest_pressure = std::max(protocol.largest_pressure, largest_pressure(reader));
  if (!stage.until.empty() && !what->takes_events())
    reader.mistake("until", "has no records to check in kind = \"" + stage.kind + "\"; allowed: with " +
                                kinds_with_events(true) + "; remove it");
  stage.what = std::move(what);
  reader.finish();
  for (const Stage& other : protocol.stages) {
    if (other.name != stage.name) continue;
    errors.push_back({line_of(table), "stage.name = \"" + stage.name +
                                          "\" is there twice; allowed: a name of its own for each (without one its "
                                          "kind is its name); give this stage another name"});
  }
  protocol.stages.push_back(std::move(stage));
  resolved.push_back(reader.resolved());
}

/// Of a protocol: to be run, or stored with the records of a test.
enum class Origin { given, recorded };

/// Checks the overrides on a specimen that has every material they name; how they fit the real one is seen when it is
/// there.
void check_overrides(const toml::table& file, Origin origin, std::vector<KeyError>& errors) {
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
  if (file["contact"]["law"] && origin == Origin::given) expect_keys_of_law(file, any, errors);
}

/// `then` names stages that are there. `tables`: those that the stages were read from, one each.
void expect_followers(const Protocol& protocol, const std::vector<const toml::table*>& tables,
                      std::vector<KeyError>& errors) {
  std::string known = "end";
  std::vector<std::string> names{"end"};
  for (const Stage& stage : protocol.stages) {
    known += ", " + stage.name;
    names.push_back(stage.name);
  }
  const auto expect = [&](const std::string& where, const std::string& then, const toml::node* place) {
    if (then.empty() || std::find(names.begin(), names.end(), then) != names.end()) return;
    const std::string message = where + ".then = \"" + then + "\" names no stage; allowed: " + known +
                                nearest_in_words(then, names) + "; correct the name";
    errors.push_back(key_error(place->source(), message));
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

void read_stages(const toml::table& file, Protocol& protocol, toml::table& resolved, std::vector<KeyError>& errors) {
  const toml::node* node = file.get("stage");
  const bool is_list = node != nullptr && node->is_array_of_tables() && !node->as_array()->empty();
  if (!is_list) {
    const std::string message =
        "the protocol has no stage; allowed: at least one [[stage]] with its keys below; add it";
    errors.push_back(node == nullptr ? KeyError{0, message} : key_error(node->source(), message));
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

Protocol read_file(toml::table file, const std::string& path, const std::vector<std::string>& assignments,
                   Origin origin = Origin::given) {
  std::vector<KeyError> errors;
  assign_all(file, assignments, errors);
  Protocol protocol;
  protocol.path = path;
  toml::table resolved;
  std::vector<std::string> known(override_tables.begin(), override_tables.end());
  known.emplace_back("stage");
  for (const TableOfProtocol& each : tables_of_protocol) known.emplace_back(each.name);
  expect_top_tables(file, errors, known);
  for (const auto& [name, read, optional] : tables_of_protocol) {
    if (optional && !file.contains(name)) continue;
    const toml::table& table = table_of(file, name, errors);
    TableReader reader(table, name, name, line_of(table), errors);
    read(reader, protocol);
    reader.finish();
    resolved.insert(name, reader.resolved());
  }
  for (const char* name : override_tables) {
    if (!file.contains(name)) continue;
    const toml::table& overrides = table_of(file, name, errors);
    protocol.overrides.insert(name, overrides);
    resolved.insert(name, overrides);
  }
  check_overrides(file, origin, errors);
  read_stages(file, protocol, resolved, errors);
  raise(path, errors);
  protocol.doubts = doubts_in(errors);
  protocol.resolved = written_file(resolved);
  return protocol;
}

}  // namespace

std::vector<Key> protocol_keys() {
  const toml::table nothing;
  std::vector<KeyError> ignored;
  std::vector<Key> all;
  Protocol protocol;
  const auto document = [&](const std::string& table, const auto& read) {
    TableReader reader(nothing, table, table, 0, ignored);
    read(reader);
    const std::vector<Key> keys = reader.keys();
    all.insert(all.end(), keys.begin(), keys.end());
  };
  for (const TableOfProtocol& each : tables_of_protocol)
    document(each.name, [&](TableReader& reader) { each.read(reader, protocol); });
  document("stage", [](TableReader& reader) {
    Stage stage;
    read_kind(reader);
    read_common(reader, stage);
  });
  for (MakeStage* const make : stage_kinds) {
    const auto kind = make();
    document(std::string("stage.") + kind->name(), [&](TableReader& reader) { kind->read(reader, protocol); });
  }
  return all;
}

std::vector<Key> all_keys() {
  std::vector<Key> all = protocol_keys();
  for (const auto& list : {pack::recipe_keys(), known_keys()}) all.insert(all.end(), list.begin(), list.end());
  return all;
}

Protocol read_protocol(const std::string& path, const std::vector<std::string>& assignments) {
  return read_file(parse_toml_file(path), path, assignments);
}

Protocol parse_protocol(const std::string& text, const std::string& path, const std::vector<std::string>& assignments) {
  return read_file(parse_toml_text(text, path), path, assignments);
}

Protocol parse_recorded_protocol(const std::string& text, const std::string& path) {
  return read_file(parse_toml_text(text, path), path, {}, Origin::recorded);
}

Specimen with_overrides(const Protocol& protocol, Specimen specimen) {
  if (protocol.dimension != 0 && protocol.dimension != specimen.cell.dimension) {
    throw InputError(protocol.path + ": the specimen has the dimension " + std::to_string(specimen.cell.dimension) +
                     "; allowed: test.dimension = " + std::to_string(protocol.dimension) +
                     "; give another specimen or another protocol");
  }
  const ContactModel contact = specimen.contact;
  const std::vector<Material> materials = specimen.materials;
  std::vector<KeyError> errors;
  for (const char* name : override_tables) {
    if (const toml::table* table = protocol.overrides[name].as_table()) read_table(specimen, name, *table, errors);
  }
  if (!protocol.overrides["contact"]["law"]) expect_keys_of_law(protocol.overrides, specimen, errors);
  raise(protocol.path, errors);
  expect_fits(protocol, specimen);
  try {
    pack::expect_possible(pack::pressed(specimen, pressure_words, protocol.largest_pressure), specimen.contact,
                          specimen.materials);
  } catch (const InputError& error) {
    throw InputError(protocol.path + ": " + error.what());
  }
  fit_state_to_parameters(specimen, contact, materials);
  return specimen;
}

std::vector<std::string> unusual_in(const Protocol& protocol, const Specimen& specimen) {
  std::vector<std::string> doubts = protocol.doubts;
  const Specimen used = with_overrides(protocol, specimen);
  std::vector<std::string> of_specimen = pack::unusual_in(used);
  for (const std::string& line : pack::unusual_overlaps(pack::pressed(used, pressure_words, protocol.largest_pressure),
                                                        used.contact, used.materials))
    of_specimen.push_back(line);
  const auto last_name = [](const std::string& doubt) {
    const std::string key = key_of_doubt(doubt);
    return key.substr(key.rfind('.') + 1);
  };
  for (const std::string& line : of_specimen) {
    const bool known = std::any_of(protocol.doubts.begin(), protocol.doubts.end(),
                                   [&](const std::string& doubt) { return last_name(doubt) == last_name(line); });
    if (!known) doubts.push_back(line);
  }
  for (const Stage& stage : protocol.stages)
    for (const std::string& line : stage.what->outside_ranges(used))
      doubts.push_back("stage." + stage.name + (line.find(" = ") == std::string::npos ? ": " : ".") + line);
  return doubts;
}

}  // namespace rvelab::protocol
