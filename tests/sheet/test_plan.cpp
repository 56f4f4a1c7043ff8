// What the plan of a data sheet says, its mistakes, and the tests that it leads to.
#include "rvelab/keys/toml_source.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/sheet/plan.hpp"
#include "tests/catch.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;
using rvelab::test::input_error;

namespace {

const std::string protocols = RVELAB_SOURCE_DIR "/protocols/";
const std::string two_densities =
    "[sheet]\nseeds = 2\npressure_Pa = 20e3\nsettings = [\"pack.number=100\"]\n"
    "[[density]]\nname = \"loose\"\nrelative_density = 0.25\n"
    "[[density]]\nname = \"dense\"\nvoid_ratio = 0.55\nsettings = [\"pack.seed=7\"]\n";

std::string test_of(const std::string& name, const std::string& purpose, const std::string& protocol) {
  return "[[test]]\nname = \"" + name + "\"\npurpose = \"" + purpose + "\"\nprotocol = \"" + protocols + protocol +
         ".toml\"\n";
}
const std::string row_drained = test_of("drained", "drained", "triaxial");

sheet::Plan read(const std::string& text, const std::vector<std::string>& assignments = {}) {
  return sheet::read_plan(keys::parse_toml(text), "plan.toml", assignments);
}

std::vector<sheet::TestVariant> variants(const std::string& text, int dimension) {
  std::vector<std::string> remarks;
  return sheet::variants_of(read(text), dimension, remarks);
}

/// The cyclic stage of the only variant.
template <class Stage>
Stage cycles_of(const std::string& text) {
  const auto all = variants(text, 3);
  REQUIRE(all.size() == 1);
  const Stage* const stage = protocol::settings_of<Stage>(all.front().protocol.stages.back());
  REQUIRE(stage != nullptr);
  return *stage;
}

}  // namespace

TEST_CASE("A plan says how specimens of each density are packed") {
  const sheet::Plan plan = read(two_densities + row_drained, {"sheet.seeds=4", "density.loose.relative_density=0.3"});
  CHECK(plan.seeds == 4);
  REQUIRE(plan.densities.size() == 2);
  CHECK(plan.recipe_settings(plan.densities[0]) ==
        std::vector<std::string>{"pack.number=100", "target.pressure_Pa=20000", "target.relative_density=0.3"});
  CHECK(plan.recipe_settings(plan.densities[1]) == std::vector<std::string>{"pack.number=100",
                                                                            "target.pressure_Pa=20000",
                                                                            "target.void_ratio=0.55", "pack.seed=7"});
  CHECK(sheet::is_of_plan("test.drained.pressures_Pa=[1e5]"));
  CHECK(!sheet::is_of_plan("target.e_min=0.5"));
}

TEST_CASE("A test of a plan is made at each pressure and amplitude, under a name of its own") {
  const auto at_pressures = variants(two_densities + row_drained + "pressures_Pa = [50e3, 400e3]\n", 3);
  REQUIRE(at_pressures.size() == 2);
  CHECK(at_pressures[0].protocol.pressure == 50e3);
  CHECK(at_pressures[1].name_with("dense", 1) == "drained_dense_400kPa_s2");
  const auto as_protocol = variants(two_densities + row_drained, 3);
  REQUIRE(as_protocol.size() == 1);
  CHECK(as_protocol[0].pressure == 100e3);
  CHECK(as_protocol[0].name_with("loose", 0) == "drained_loose_s1");
  const auto cyclic =
      variants(two_densities + test_of("G", "cyclic_strain", "cyclic_shear") + "amplitudes = [1e-5, 1e-3]\n", 2);
  REQUIRE(cyclic.size() == 2);
  CHECK(cyclic[0].name_with("loose", 0) == "G_loose_1e-05_s1");
}

TEST_CASE("Amplitudes are of the strain, or of the stress as the kind of test defines its ratio to the pressure") {
  const auto strained =
      cycles_of<protocol::SimpleShearStage>(two_densities + test_of("G", "cyclic_strain", "cyclic_shear") +
                                            "amplitudes = [1e-4]\nrecords_per_amplitude = 10\n");
  CHECK(strained.to_strain == 1e-4);
  CHECK(strained.record_every == Approx(1e-5));
  const std::string ratio = "pressures_Pa = [200e3]\namplitudes = [0.25]\n";
  const auto triaxial =
      cycles_of<protocol::CompressionStage>(two_densities + test_of("L", "cyclic_stress", "triaxial_cyclic") + ratio);
  CHECK(triaxial.cycles.reverse_at == Approx(2 * 0.25 * 200e3));  // q/(2 p)
  const auto sheared = cycles_of<protocol::SimpleShearStage>(
      two_densities + test_of("L", "cyclic_stress", "cyclic_liquefaction") + ratio);
  CHECK(sheared.cycles.reverse_at == Approx(0.25 * 200e3));  // tau/p
}

TEST_CASE("Grains in the plane get the protocol of the plane; what they have none for is left out, and said") {
  std::vector<std::string> remarks;
  const sheet::Plan plan = read(two_densities + row_drained + "protocol_2D = \"" + protocols + "biaxial.toml\"\n" +
                                test_of("K0", "oedometer", "oedometer_unloading"));
  const auto plane = sheet::variants_of(plan, 2, remarks);
  REQUIRE(plane.size() == 1);
  CHECK(plane[0].protocol.name == "biaxial compression");
  REQUIRE(remarks.size() == 2);
  CHECK_THAT(remarks[0], Contains("drained is biaxial in the place of triaxial"));
  CHECK_THAT(remarks[1], Contains("K0 is left out: oedometer_unloading is a test in space"));
  remarks.clear();
  CHECK(sheet::variants_of(plan, 3, remarks).size() == 2);
  CHECK(remarks.empty());
  CHECK_THAT(input_error([] { variants(two_densities + row_drained, 2); }), Contains("every test is left out"));
}

TEST_CASE("A test may be of some densities, or of the first seeds, alone") {
  const sheet::Plan plan = read(two_densities + row_drained + "densities = [\"loose\"]\nseeds = 1\n");
  CHECK(sheet::goes_through(plan, plan.tests[0], "loose", 0));
  CHECK(!sheet::goes_through(plan, plan.tests[0], "loose", 1));
  CHECK(!sheet::goes_through(plan, plan.tests[0], "dense", 0));
  CHECK(sheet::goes_through(plan, plan.tests[0], "of_a_file", 0));
}

TEST_CASE("Mistakes of a plan are named with their lines and a remedy") {
  const auto refused = [](const std::string& text) { return input_error([&] { read(text); }); };
  CHECK_THAT(refused(two_densities), Contains("[[test]]"));
  CHECK_THAT(refused(row_drained), Contains("[[density]]"));
  CHECK_THAT(refused(two_densities + "[[density]]\nname = \"x\"\n" + row_drained),
             Contains("says nothing of its specimens"));
  CHECK_THAT(refused(two_densities + "[[density]]\nname = \"loose\"\nvoid_ratio = 0.6\n" + row_drained),
             Contains("stands twice"));
  CHECK_THAT(refused(two_densities + "[[density]]\nname = \"a/b\"\nvoid_ratio = 0.6\n" + row_drained),
             Contains("no name of a file"));
  CHECK_THAT(refused(two_densities + row_drained + "presures_Pa = [1e5]\n"),
             Contains("plan.toml:16") && Contains("nearest") && Contains("pressures_Pa"));
  CHECK_THAT(refused(two_densities + test_of("a", "drianed", "triaxial")), Contains("purpose") && Contains("drained"));
  CHECK_THAT(refused(two_densities + test_of("a", "cyclic_stress", "triaxial_cyclic")), Contains("amplitudes"));
  CHECK_THAT(refused(two_densities + row_drained + "amplitudes = [0.1]\n"), Contains("contradicts purpose"));
  CHECK_THAT(refused(two_densities + row_drained + "densities = [\"lose\"]\n"), Contains("nearest is loose"));
  CHECK_THAT(refused(two_densities + "[plan]\n" + row_drained), Contains("plan"));
  const auto unfit = [](const std::string& purpose, const std::string& protocol, const std::string& more = "") {
    return input_error([&] { variants(two_densities + test_of("a", purpose, protocol) + more, 3); });
  };
  CHECK_THAT(unfit("drained", "triaxial_undrained"), Contains("test.a") && Contains("constant lateral stress"));
  CHECK_THAT(unfit("undrained", "triaxial"), Contains("compression at constant volume"));
  CHECK_THAT(unfit("undrained_shear", "simple_shear_drained"), Contains("simple shear at constant volume"));
  CHECK_THAT(unfit("isotropic", "isotropic_compression"), Contains("probe"));
  CHECK_THAT(unfit("drained", "triaxial_extension"), Contains("to_strain > 0"));
  const std::string extension = "settings = [\"stage.compression.to_strain=-0.1\"]\n";
  CHECK_THAT(unfit("undrained", "triaxial_undrained", extension), Contains("in one direction, to_strain > 0"));
  CHECK_THAT(unfit("undrained", "triaxial_cyclic"), Contains("without cycles"));
  CHECK_THAT(unfit("undrained_shear", "cyclic_liquefaction"), Contains("without cycles"));
  CHECK_THAT(unfit("oedometer", "triaxial"), Contains("moves one axis alone"));
  CHECK_THAT(unfit("oedometer", "constant_p"), Contains("moves one axis alone"));
  CHECK(variants(two_densities + test_of("a", "oedometer", "oedometer"), 3).size() == 1);
  CHECK_THAT(unfit("cyclic_strain", "triaxial_cyclic_strain", "amplitudes = [1e-3]\n"), Contains("of a compression"));
  CHECK_THAT(unfit("cyclic_strain", "cyclic_liquefaction", "amplitudes = [1e-3]\n"), Contains("reverse_at_Pa"));
  CHECK_THAT(unfit("drained", "triaxial",
                   "pressures_Pa = [50e3]\nsettings = [\"stage.isotropic.pressure_Pa=100e3\", "
                   "\"stage.compression.lateral_pressure_Pa=100e3\"]\n"),
             Contains("test.a.pressures_Pa") && Contains("takes its pressure from test.pressure_Pa"));
  CHECK_THAT(unfit("cyclic_strain", "triaxial", "amplitudes = [1e-3]\n"), Contains("with cycles"));
}

TEST_CASE("The plans that come with rvelab have a test for every purpose, in space and in the plane") {
  for (const std::string name : {"standard", "quick"}) {
    CAPTURE(name);
    const std::string path = protocols + "sheets/" + name + ".toml";
    sheet::Plan plan = sheet::read_plan(keys::parse_toml_file(path), path);
    for (sheet::PlanTest& test : plan.tests) {
      test.protocol = protocols + test.protocol + ".toml";
      if (!test.protocol_2D.empty()) test.protocol_2D = protocols + test.protocol_2D + ".toml";
    }
    for (const int dimension : {2, 3}) {
      std::vector<std::string> remarks;
      std::vector<bool> there(sheet::purpose_names().size(), false);
      for (const sheet::TestVariant& variant : sheet::variants_of(plan, dimension, remarks))
        there[std::size_t(plan.tests[variant.row].purpose)] = true;
      CHECK(std::count(there.begin(), there.end(), false) == 0);
    }
  }
}
