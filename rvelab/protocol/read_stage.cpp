#include "rvelab/protocol/read_stage.hpp"

#include <cmath>

#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

double strain_of(const toml::table& table, TableReader& reader) {
  const double strain = reader.number("to_strain");
  if (table["to_strain"].value<double>() == 0.0) {
    reader.mistake("to_strain", "goes nowhere; allowed: not 0; give the strain at which the stage ends");
  }
  return strain;
}

/// In 2D nothing moves along z.
void expect_in_plane(TableReader& reader, const std::string& key, const std::string& value, const Protocol& protocol) {
  if (protocol.dimension == 2 && value.find('z') != std::string::npos) {
    reader.mistake(key, "leaves the plane of test.dimension = 2; allowed: x and y; change one of the two");
  }
}

Cycles read_cycles(TableReader& reader, double to_strain, double record_every) {
  Cycles cycles;
  cycles.count = reader.whole_number("cycles");
  cycles.reverse_at = reader.optional_number("reverse_at_Pa").value_or(0);
  if (reader.has("reverse_at_Pa") && cycles.count == 0) {
    reader.mistake("reverse_at_Pa", "has nothing to turn; allowed: with cycles > 0 only; give cycles, or remove it");
  }
  const double records = 4 * static_cast<double>(cycles.count) * std::abs(to_strain) / record_every;
  if (records > most_records) {
    reader.mistake("cycles", "gives up to " + std::to_string(records) +
                                 " records; allowed: at most 1000000; give fewer cycles or a larger record_every");
  }
  return cycles;
}

IsotropicStage read_isotropic(TableReader& reader, Protocol& protocol) {
  IsotropicStage stage;
  stage.pressure = pressure_of(reader, "pressure_Pa", protocol);
  stage.shear_stress_free = reader.word("shear") == "zero_stress";
  stage.stress_tolerance = reader.number("stress_tolerance");
  stage.unbalanced = reader.number("unbalanced");
  stage.largest_change = reader.number("largest_change");
  stage.max_rounds = reader.whole_number("max_rounds");
  stage.max_steps = reader.whole_number("max_steps");
  stage.record = reader.truth("record");
  return stage;
}

CompressionStage read_compression(const toml::table& table, TableReader& reader, Protocol& protocol) {
  CompressionStage stage;
  const char* usual = protocol.dimension == 0 ? "" : protocol.dimension == 2 ? "y" : "z";
  stage.axis = reader.word("axis", usual);
  expect_in_plane(reader, "axis", stage.axis, protocol);
  stage.to_strain = strain_of(table, reader);
  stage.record_every = spacing_of(reader, stage.to_strain);
  const std::string lateral = reader.word("lateral");
  if (lateral == "constant_volume") stage.lateral = CompressionStage::Lateral::constant_volume;
  if (lateral == "zero_strain") stage.lateral = CompressionStage::Lateral::zero_strain;
  if (stage.lateral == CompressionStage::Lateral::constant_stress) {
    stage.lateral_pressure = pressure_of(reader, "lateral_pressure_Pa", protocol);
  } else {
    refuse_pressure(reader, "lateral_pressure_Pa", "lateral = \"" + lateral + "\"");
  }
  stage.cycles = read_cycles(reader, stage.to_strain, stage.record_every);
  return stage;
}

SimpleShearStage read_simple_shear(const toml::table& table, TableReader& reader, Protocol& protocol) {
  SimpleShearStage stage;
  const char* usual = protocol.dimension == 0 ? "" : protocol.dimension == 2 ? "xy" : "xz";
  stage.plane = reader.word("plane", usual);
  expect_in_plane(reader, "plane", stage.plane, protocol);
  stage.to_strain = strain_of(table, reader);
  stage.record_every = spacing_of(reader, stage.to_strain);
  if (reader.word("normal") == "constant_volume") {
    refuse_pressure(reader, "normal_pressure_Pa", "normal = \"constant_volume\"");
  } else {
    stage.normal = SimpleShearStage::Normal::constant_stress;
    stage.normal_pressure = pressure_of(reader, "normal_pressure_Pa", protocol);
  }
  stage.cycles = read_cycles(reader, stage.to_strain, stage.record_every);
  return stage;
}

RelaxStage read_relax(TableReader& reader) {
  RelaxStage stage;
  stage.unbalanced = reader.number("unbalanced");
  stage.max_steps = reader.whole_number("max_steps");
  stage.record = reader.truth("record");
  return stage;
}

ProbeStage read_probe(TableReader& reader) {
  ProbeStage stage;
  const bool linear = reader.word("method") == "linear";
  stage.method = linear ? ProbeStage::Method::linear : ProbeStage::Method::dynamic;
  stage.size = reader.number("size");
  stage.no_slip = reader.truth("no_slip", linear);
  if (linear && !stage.no_slip) {
    reader.mistake("no_slip",
                   "contradicts method = \"linear\", in which every contact is stuck; allowed: true with "
                   "it; remove the key or take method = \"dynamic\"");
  }
  return stage;
}

}  // namespace

void read_stage(const toml::table& table, long number, Protocol& protocol, toml::array& resolved,
                std::vector<KeyError>& errors) {
  const std::string kind_given = table["kind"].value_or(std::string());
  const std::string name = table["name"].value_or(kind_given.empty() ? std::to_string(number) : kind_given);
  TableReader reader(table, protocol_keys(), "stage", "stage." + name, line_of(table), errors);
  const auto kind = reader.word("kind");
  if (kind.empty()) return;  // without its kind no other key can be judged
  reader.also("stage." + kind);
  Stage stage{reader.text("name", kind), {}, {}, ""};
  if (kind == "isotropic") stage.what = read_isotropic(reader, protocol);
  if (kind == "compression") stage.what = read_compression(table, reader, protocol);
  if (kind == "simple_shear") stage.what = read_simple_shear(table, reader, protocol);
  if (kind == "deviatoric") stage.what = read_deviatoric(reader, protocol);
  if (kind == "pressure_path") stage.what = read_pressure_path(reader);
  if (kind == "path") stage.what = read_path(reader, stage.name, protocol, errors);
  if (kind == "flow") stage.what = read_flow(reader, protocol);
  if (kind == "deformation") stage.what = read_deformation(reader, protocol);
  if (kind == "envelope") stage.what = read_envelope(reader);
  if (kind == "relax") stage.what = read_relax(reader);
  if (kind == "probe") stage.what = read_probe(reader);
  stage.until = read_until(reader, stage.name, kind, errors);
  stage.then = reader.text("then", "");
  reader.finish();
  for (const auto& other : protocol.stages) {
    if (other.name != stage.name) continue;
    errors.push_back({line_of(table), "stage.name = \"" + stage.name +
                                          "\" is there twice; allowed: a name of its own for each (without one its "
                                          "kind is its name); give this stage another name"});
  }
  protocol.stages.push_back(std::move(stage));
  resolved.push_back(reader.resolved());
}

}  // namespace rvelab::protocol
