#include "rvelab/protocol/read_stage.hpp"

#include <cmath>

namespace rvelab::protocol {
namespace {

constexpr double most_records = 1e6;

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

double strain_of(const toml::table& table, TableReader& reader) {
  const double strain = reader.number("to_strain");
  if (table["to_strain"].value<double>() == 0.0) {
    reader.mistake("to_strain", "goes nowhere; allowed: not 0; give the strain at which the stage ends");
  }
  return strain;
}

double spacing_of(TableReader& reader, double to_strain) {
  const double spacing = reader.number("record_every");
  if (std::abs(to_strain) / spacing > most_records) {
    reader.mistake("record_every", "gives " + std::to_string(std::abs(to_strain) / spacing) +
                                       " records; allowed: at most 1000000; give a larger spacing");
  }
  return spacing;
}

/// In 2D nothing moves along z.
void expect_in_plane(TableReader& reader, const std::string& key, const std::string& value, const Protocol& protocol) {
  if (protocol.dimension == 2 && value.find('z') != std::string::npos) {
    reader.mistake(key, "leaves the plane of test.dimension = 2; allowed: x and y; change one of the two");
  }
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
  if (reader.word("lateral") == "constant_volume") {
    stage.lateral = CompressionStage::Lateral::constant_volume;
    refuse_pressure(reader, "lateral_pressure_Pa", "lateral = \"constant_volume\"");
  } else {
    stage.lateral_pressure = pressure_of(reader, "lateral_pressure_Pa", protocol);
  }
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
  TableReader reader(table, "stage", "stage." + name, line_of(table), errors);
  const auto kind = reader.word("kind");
  if (kind.empty()) return;  // without its kind no other key can be judged
  reader.also("stage." + kind);
  Stage stage{reader.text("name", kind), {}};
  if (kind == "isotropic") stage.what = read_isotropic(reader, protocol);
  if (kind == "compression") stage.what = read_compression(table, reader, protocol);
  if (kind == "simple_shear") stage.what = read_simple_shear(table, reader, protocol);
  if (kind == "relax") stage.what = read_relax(reader);
  if (kind == "probe") stage.what = read_probe(reader);
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
