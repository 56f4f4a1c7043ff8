#include "rvelab/protocol/read_stage.hpp"

#include <cmath>

namespace rvelab::protocol {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr io::Range positive{0, infinity, true, true};
constexpr io::Range ratio{0, 1, true, true};
constexpr io::Range steps{1, 1e12};
constexpr double most_records = 1e6;

/// A stage's own pressure, or the test's.
double pressure_of(TableReader& reader, const std::string& key, Protocol& protocol) {
  if (reader.has(key)) return reader.number(key, std::nullopt, positive);
  if (std::isnan(protocol.pressure)) {
    reader.know(key);
    reader.mistake(key, "is missing, and so is test.pressure_Pa; allowed: > 0; add one of them");
    return 0;
  }
  protocol.uses_pressure = true;
  return reader.number(key, protocol.pressure, positive);
}

/// A pressure that the stage holds nothing at.
void refuse_pressure(TableReader& reader, const std::string& key, const std::string& other) {
  reader.know(key);
  if (reader.has(key)) reader.mistake(key, "contradicts " + other + "; allowed: one of the two; remove one");
}

double strain_of(TableReader& reader, const io::Range& range) {
  const double strain = reader.number("to_strain", std::nullopt, range);
  if (reader.has("to_strain") && strain == 0) {
    reader.mistake("to_strain", "goes nowhere; allowed: not 0; give the strain at which the stage ends");
  }
  return strain;
}

double spacing_of(TableReader& reader, double initial, double to_strain) {
  const double spacing = reader.number("record_every", initial, positive);
  if (spacing > 0 && std::abs(to_strain) / spacing > most_records) {
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
  stage.shear_stress_free = reader.word("shear", "zero_strain", {"zero_strain", "zero_stress"}) == "zero_stress";
  stage.stress_tolerance = reader.number("stress_tolerance", stage.stress_tolerance, ratio);
  stage.unbalanced = reader.number("unbalanced", stage.unbalanced, ratio);
  stage.largest_change = reader.number("largest_change", stage.largest_change, {0, 1, true, false});
  stage.max_rounds = reader.whole_number("max_rounds", stage.max_rounds, steps);
  stage.max_steps = reader.whole_number("max_steps", stage.max_steps, steps);
  stage.record = reader.truth("record", stage.record);
  return stage;
}

CompressionStage read_compression(TableReader& reader, Protocol& protocol) {
  CompressionStage stage;
  const char* usual = protocol.dimension == 0 ? "" : protocol.dimension == 2 ? "y" : "z";
  stage.axis = reader.word("axis", usual, {"x", "y", "z"});
  expect_in_plane(reader, "axis", stage.axis, protocol);
  stage.to_strain = strain_of(reader, {-infinity, 1, true, true});
  stage.record_every = spacing_of(reader, stage.record_every, stage.to_strain);
  if (reader.word("lateral", "constant_stress", {"constant_stress", "constant_volume"}) == "constant_volume") {
    stage.lateral = CompressionStage::Lateral::constant_volume;
    refuse_pressure(reader, "lateral_pressure_Pa", "lateral = \"constant_volume\"");
  } else {
    stage.lateral_pressure = pressure_of(reader, "lateral_pressure_Pa", protocol);
  }
  return stage;
}

SimpleShearStage read_simple_shear(TableReader& reader, Protocol& protocol) {
  SimpleShearStage stage;
  const char* usual = protocol.dimension == 0 ? "" : protocol.dimension == 2 ? "xy" : "xz";
  stage.plane = reader.word("plane", usual, {"xy", "xz", "yz", "yx", "zx", "zy"});
  expect_in_plane(reader, "plane", stage.plane, protocol);
  stage.to_strain = strain_of(reader, {-infinity, infinity, true, true});
  stage.record_every = spacing_of(reader, stage.record_every, stage.to_strain);
  if (reader.word("normal", "constant_volume", {"constant_volume", "constant_stress"}) == "constant_volume") {
    refuse_pressure(reader, "normal_pressure_Pa", "normal = \"constant_volume\"");
  } else {
    stage.normal = SimpleShearStage::Normal::constant_stress;
    stage.normal_pressure = pressure_of(reader, "normal_pressure_Pa", protocol);
  }
  return stage;
}

RelaxStage read_relax(TableReader& reader) {
  RelaxStage stage;
  stage.unbalanced = reader.number("unbalanced", stage.unbalanced, ratio);
  stage.max_steps = reader.whole_number("max_steps", stage.max_steps, steps);
  stage.record = reader.truth("record", stage.record);
  return stage;
}

ProbeStage read_probe(TableReader& reader) {
  ProbeStage stage;
  const bool linear = reader.word("method", "dynamic", {"dynamic", "linear"}) == "linear";
  stage.method = linear ? ProbeStage::Method::linear : ProbeStage::Method::dynamic;
  stage.size = reader.number("size", stage.size, {0, 0.01, true, false});
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
  TableReader reader(table, "stage." + name, line_of(table), errors);
  const auto kind = reader.word("kind", std::nullopt, {"isotropic", "compression", "simple_shear", "relax", "probe"});
  if (kind.empty()) return;  // without its kind no other key can be judged
  Stage stage{reader.text("name", kind), {}};
  if (kind == "isotropic") stage.what = read_isotropic(reader, protocol);
  if (kind == "compression") stage.what = read_compression(reader, protocol);
  if (kind == "simple_shear") stage.what = read_simple_shear(reader, protocol);
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
