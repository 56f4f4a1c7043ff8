// A protocol file says exactly what is run: every mistake in it is told, nothing is guessed.
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "tests/catch.hpp"
#include "tests/protocol/texts.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

const std::string biaxial_text = R"([test]
name = "biaxial"
dimension = 2
pressure_Pa = 20e3

[[stage]]
kind = "isotropic"

[[stage]]
kind = "compression"
to_strain = 0.15
)";

std::size_t lines(const std::string& text) {
  return text.empty() ? 0 : 1 + static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

template <class What>
const What& stage_of(const protocol::Protocol& protocol, std::size_t number) {
  return *protocol::settings_of<What>(protocol.stages.at(number));
}

}  // namespace

TEST_CASE("What a protocol leaves out has the documented defaults") {
  const protocol::Protocol protocol = protocol::parse_protocol(biaxial_text, "test.toml");
  CHECK(protocol.name == "biaxial");
  CHECK(protocol.pressure == 20e3);
  CHECK(protocol.uses_pressure);
  CHECK_FALSE(protocol.loading.at_rate);
  CHECK(protocol.loading.held_tolerance == 0.005);
  REQUIRE(protocol.stages.size() == 2);
  CHECK(protocol.stages[0].name == "isotropic");
  const auto& isotropic = stage_of<protocol::IsotropicStage>(protocol, 0);
  CHECK(isotropic.pressure == 20e3);
  CHECK_FALSE(isotropic.shear_stress_free);
  CHECK(isotropic.stress_tolerance == 1e-4);
  CHECK(isotropic.unbalanced == 1e-5);
  const auto& compression = stage_of<protocol::CompressionStage>(protocol, 1);
  CHECK(compression.axis == "y");
  CHECK(compression.to_strain == 0.15);
  CHECK(compression.record_every == 0.0005);
  CHECK(compression.lateral == protocol::CompressionStage::Lateral::constant_stress);
  CHECK(compression.lateral_pressure == 20e3);
}

TEST_CASE("A stage's own pressure goes before the test's") {
  const std::string text = biaxial_text + "lateral_pressure_Pa = 35e3\n";
  const protocol::Protocol protocol = protocol::parse_protocol(text, "test.toml", {"stage.isotropic.pressure_Pa=30e3"});
  CHECK(stage_of<protocol::IsotropicStage>(protocol, 0).pressure == 30e3);
  CHECK(stage_of<protocol::CompressionStage>(protocol, 1).lateral_pressure == 35e3);
  CHECK_FALSE(protocol.uses_pressure);
}

TEST_CASE("The resolved text is a protocol that says the same and stays as it is when read again") {
  const std::string text =
      biaxial_text + "[contact]\nslip = \"full_radius\"\n[material]\nfriction = 0.4\n[solver]\nskin = 0.2\n";
  const protocol::Protocol first =
      protocol::parse_protocol(text, "test.toml", {"stage.compression.record_every=0.0007"});
  const protocol::Protocol second = protocol::parse_protocol(first.resolved, "resolved.toml");
  CHECK(second.resolved == first.resolved);
  CHECK(second.pressure == first.pressure);
  CHECK(stage_of<protocol::CompressionStage>(second, 1).record_every == 0.0007);
  CHECK(second.overrides["contact"]["slip"].value<std::string>() == "full_radius");
  for (const char* part : {"held_tolerance", "stress_tolerance", "unbalanced", "lateral_pressure_Pa", "max_rounds"}) {
    CHECK(contains(first.resolved, part));
  }
}

TEST_CASE("All unknown keys are told at once, with line and nearest known key") {
  const std::string text = R"([test]
name = "biaxial"
presure_Pa = 20e3
pressure_Pa = 20e3
[loadings]
mode = "at_rate"
[contact]
slop = "consistent"
[[stage]]
kind = "compression"
to_strian = 0.1
to_strain = 0.1
[specimen]
fiel = "S.h5"
file = "S.h5"
)";
  const std::string message = message_of(text);
  CHECK(lines(message) == 5);
  const std::vector<std::vector<std::string>> told{{"test.toml:3: ", "test.presure_Pa", "test.pressure_Pa"},
                                                   {"test.toml:5: ", "loadings", "loading;"},
                                                   {"test.toml:8: ", "contact.slop", "contact.slip"},
                                                   {"test.toml:11: ", "to_strian", "stage.compression.to_strain"},
                                                   {"test.toml:14: ", "specimen.fiel", "specimen.file"}};
  std::istringstream each(message);
  for (const auto& words : told) {
    std::string line;
    std::getline(each, line);
    CAPTURE(line);
    CHECK(contains(line, "nearest"));
    for (const std::string& word : words) CHECK(contains(line, word));
  }
}

TEST_CASE("A key of another kind of stage is unknown") {
  CHECK(contains(message_of(biaxial_text + "plane = \"xy\"\n"), "unknown key stage.compression.plane"));
  CHECK(contains(message_of(biaxial_text, {"stage.isotropic.to_strain=0.1"}), "unknown key stage.isotropic.to_strain"));
}

TEST_CASE("Missing keys are told by name") {
  CHECK(contains(message_of("[test]\nname = \"t\"\n"), "no stage"));
  const std::string message = message_of(
      "[test]\n[[stage]]\nkind = \"compression\"\n[[stage]]\nname = \"b\"\n[[stage]]\nkind = \"isotropic\"\n");
  CHECK(lines(message) == 5);
  CHECK(contains(message, "test.name is missing"));
  CHECK(contains(message, "stage.compression.to_strain is missing"));
  CHECK(contains(message, "stage.compression.lateral_pressure_Pa is missing, and so is test.pressure_Pa"));
  CHECK(contains(message, "stage.b.kind is missing; allowed: isotropic, compression, simple_shear, pressure_path, "));
  CHECK(contains(message, "stage.isotropic.pressure_Pa is missing"));
}

TEST_CASE("Wrong types, numbers that are not finite and values out of range are refused with what is allowed") {
  const auto refused = [](const std::string& assignment, const std::string& part) {
    const std::string message = message_of(biaxial_text, {assignment});
    INFO(assignment << " -> " << message);
    CHECK(lines(message) == 1);
    CHECK(contains(message, part));
    CHECK(contains(message, "allowed"));
  };
  refused("test.pressure_Pa=-5", "test.pressure_Pa = -5 is out of range");
  refused("test.pressure_Pa=-1", "out of range");
  refused("test.pressure_Pa=nan", "is not finite");
  refused("test.pressure_Pa=inf", "is not finite");
  refused("test.pressure_Pa=high", "test.pressure_Pa = 'high' is not a number");
  refused("test.pressure_Pa=true", "is not a number");
  refused("test.dimension=4", "out of range");
  refused("test.dimension=2.0", "is not a whole number");
  refused("stage.compression.to_strain=1", "out of range");
  refused("stage.compression.to_strain=0", "goes nowhere");
  refused("stage.compression.record_every=1e-9", "records");
  refused("stage.compression.lateral=free", "is not known; allowed: constant_stress, constant_volume");
  refused("stage.compression.axis=z", "leaves the plane");
  refused("stage.isotropic.max_rounds=1.5", "is not a whole number");
  refused("stage.isotropic.record=1", "is neither true nor false");
  refused("loading.held_tolerance=0", "out of range");
  refused("contact.slip=sideways", "contact.slip");
  refused("solver.skin=-1", "solver.skin");
  refused("material.friction=-0.1", "material.friction");
}

TEST_CASE("Keys that contradict each other are refused") {
  const auto refused = [](const std::string& text, const std::string& part) {
    const std::string message = message_of(text);
    INFO(message);
    CHECK(lines(message) == 1);
    CHECK(contains(message, part));
  };
  refused(biaxial_text + "[loading]\nmode = \"at_rate\"\nrate_1_s = 0.1\ninertial_number = 1e-3\n", "contradicts");
  refused(biaxial_text + "[loading]\nrate_1_s = 0.1\n", "contradicts loading.mode = \"quasi_static\"");
  refused(biaxial_text + "[loading]\nmode = \"at_rate\"\n", "needs a rate");
  refused(biaxial_text + "lateral = \"constant_volume\"\nlateral_pressure_Pa = 1e4\n", "contradicts lateral");
  refused(biaxial_text + "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.1\nnormal_pressure_Pa = 1e4\n",
          "contradicts normal");
  refused(biaxial_text + "[[stage]]\nkind = \"probe\"\nmethod = \"linear\"\nno_slip = false\n", "contradicts method");
  refused(biaxial_text + "[[stage]]\nkind = \"compression\"\nto_strain = -0.1\n", "is there twice");
}

TEST_CASE(
    "Assignments act before the file is checked, on stages by name or number, and words need no quotation marks") {
  const protocol::Protocol by_name =
      protocol::parse_protocol(biaxial_text, "t", {"stage.compression.to_strain=0.05", "test.pressure_Pa=2e4"});
  CHECK(stage_of<protocol::CompressionStage>(by_name, 1).to_strain == 0.05);
  const protocol::Protocol by_number =
      protocol::parse_protocol(biaxial_text, "t", {"stage.1.lateral=constant_volume", "test.name = a b"});
  CHECK(stage_of<protocol::CompressionStage>(by_number, 1).lateral ==
        protocol::CompressionStage::Lateral::constant_volume);
  CHECK(by_number.name == "a b");
  const protocol::Protocol new_tables = protocol::parse_protocol(
      biaxial_text, "t", {"contact.slip=full_radius_ratcheting", "material.sand.friction=0.5"});
  CHECK(new_tables.overrides["contact"]["slip"].value<std::string>() == "full_radius_ratcheting");
  CHECK(new_tables.overrides["material"]["sand"]["friction"].value<double>() == 0.5);
  // The later one wins.
  CHECK(protocol::parse_protocol(biaxial_text, "t", {"test.pressure_Pa=1e4", "test.pressure_Pa=3e4"}).pressure == 3e4);
  // A mistake in one is told like one in the file.
  CHECK(contains(message_of(biaxial_text, {"test.presure_Pa=1"}), "nearest known key is test.pressure_Pa"));
  CHECK(contains(message_of(biaxial_text, {"stage.7.to_strain=0.1"}), "allowed: 0 (isotropic), 1 (compression)"));
  CHECK(contains(message_of(biaxial_text, {"stage.shear.to_strain=0.1"}), "names no stage"));
  for (const char* wrong : {"pressure", "test.pressure_Pa", "test.pressure_Pa=", "=3", "pressure_Pa=3", "test..a=1",
                            "stage.1=3", "test.name.more=1"}) {
    INFO(wrong);
    CHECK_THROWS_AS(protocol::parse_protocol(biaxial_text, "t", {wrong}), InputError);
  }
}

TEST_CASE("A text that is not TOML is refused with its line") {
  CHECK(contains(message_of("[test]\nname = \n"), "test.toml:2"));
  CHECK_THROWS_AS(protocol::read_protocol("no/such/file.toml"), InputError);
}

TEST_CASE("Overrides reach the specimen and must fit it") {
  Specimen specimen;
  specimen.shape = Shape::disc;
  specimen.cell.dimension = 2;
  specimen.materials.resize(2);
  specimen.materials[0].name = "sand";
  specimen.materials[1].name = "steel";
  const std::string text =
      biaxial_text + "[contact]\nslip = \"full_radius\"\n[material]\nfriction = 0.3\nsteel.friction = 0.1\n";
  const Specimen changed = protocol::with_overrides(protocol::parse_protocol(text, "t"), specimen);
  CHECK(changed.contact.slip == Slip::full_radius);
  CHECK(changed.materials[0].friction == 0.3);
  CHECK(changed.materials[1].friction == 0.1);
  CHECK_THROWS_AS(protocol::with_overrides(
                      protocol::parse_protocol(biaxial_text + "[material.clay]\nfriction = 0.3\n", "t"), specimen),
                  InputError);
  specimen.cell.dimension = 3;
  CHECK_THROWS_AS(protocol::with_overrides(protocol::parse_protocol(biaxial_text, "t"), specimen), InputError);
}

TEST_CASE("A law of --set goes over the keys of the file's law; a recorded protocol is read as it was run") {
  Specimen specimen;
  specimen.shape = Shape::disc;
  specimen.cell.dimension = 2;
  specimen.materials.resize(1);
  const std::string text = biaxial_text +
                           "[contact]\nlaw = \"hertz_stiffness\"\n[material]\n"
                           "normal_stiffness_N_m1_5 = 1e9\nfriction = 0.3\n";
  const protocol::Protocol run = protocol::parse_protocol(
      text, "t", {"contact.law=hertz_mindlin", "material.young_modulus_Pa=1e9", "material.poisson_ratio=0.2"});
  CHECK(protocol::with_overrides(run, specimen).contact.law == Law::hertz_mindlin);
  CHECK(protocol::parse_recorded_protocol(run.resolved, "t").overrides == run.overrides);
  CHECK_THROWS_WITH(protocol::parse_protocol(run.resolved, "t"), Contains("material.normal_stiffness_N_m1_5"));
  // Without a law that of the specimen counts.
  const protocol::Protocol bare = protocol::parse_protocol(biaxial_text + "[material]\nroughness_m = 1e-7\n", "t");
  CHECK_THROWS_WITH(protocol::with_overrides(bare, specimen), Contains("material.roughness_m"));
}

TEST_CASE("A stiffness that a test overrides parts the specimen from masses that were scaled for another") {
  Specimen specimen;
  specimen.shape = Shape::disc;
  specimen.cell.dimension = 2;
  specimen.materials.resize(1);
  specimen.materials[0].young_modulus = 8e8;
  specimen.state.masses.in_use = true;
  specimen.state.masses.steps = 3;
  specimen.state.masses.mass = specimen.state.masses.inverse_inertia = {1.0, 2.0};
  const auto overridden = [&](const std::string& line) {
    return protocol::with_overrides(protocol::parse_protocol(biaxial_text + "[material]\n" + line + "\n", "t"),
                                    specimen)
        .state.masses;
  };
  for (const char* same : {"friction = 0.3", "young_modulus_Pa = 8e8", "density_kg_m3 = 2000"}) {
    INFO(same);
    CHECK(overridden(same).steps == 3);
    CHECK(overridden(same).mass == specimen.state.masses.mass);
  }
  for (const char* other : {"young_modulus_Pa = 8e10", "stiffness_ratio = 0.7", "rolling_stiffness = 2"}) {
    INFO(other);
    CHECK(!overridden(other).in_use);
    CHECK(overridden(other).mass.empty());
  }
}

TEST_CASE("Every protocol that comes with rvelab is one, and opens with what it is") {
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(RVELAB_SOURCE_DIR "/protocols")) {
    if (entry.path().extension() != ".toml") continue;  // studies, README
    INFO(entry.path());
    if (pack::is_recipe(entry.path().string())) continue;  // read in test_recipe.cpp
    CHECK_NOTHROW(protocol::read_protocol(entry.path().string()));
    ++found;
  }
  CHECK(found >= 4);
  const protocol::Protocol protocol = protocol::read_protocol(RVELAB_SOURCE_DIR "/protocols/biaxial.toml");
  CHECK(protocol.calibration_pressures == std::vector<double>{10e3, 15e3, 20e3, 25e3, 30e3});
  CHECK(stage_of<protocol::CompressionStage>(protocol, 1).to_strain == 0.15);
  CHECK(stage_of<protocol::CompressionStage>(protocol, 1).record_every == 0.0005);
}
