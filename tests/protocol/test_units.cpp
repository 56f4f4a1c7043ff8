// Pressures and overrides of a protocol that are likely in another unit.
#include <filesystem>

#include "rvelab/error.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "tests/catch.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

protocol::Protocol with_units(const std::string& text, const std::vector<std::string>& settings = {}) {
  return protocol::parse_protocol("[test]\nname = \"units\"\n" + text, "units.toml", settings);
}

const std::string usual_compression = "pressure_Pa = 20e3\n[[stage]]\nkind = \"compression\"\nto_strain = 0.01\n";

}  // namespace

TEST_CASE("no shipped test is told to be in other units") {
  std::size_t tests = 0;
  for (const auto& entry : std::filesystem::directory_iterator(RVELAB_SOURCE_DIR "/protocols")) {
    const std::string path = entry.path().string();
    if (entry.path().extension() != ".toml" || entry.path().stem().string().starts_with("pack_")) continue;
    const auto doubts = protocol::read_protocol(path).doubts;
    CAPTURE(path, doubts);
    CHECK(doubts.empty());
    ++tests;
  }
  CHECK(tests > 15);
}

TEST_CASE("every pressure of a protocol is looked at, once a key") {
  CHECK(with_units(usual_compression).doubts.empty());
  const auto path = with_units("[[stage]]\nkind = \"pressure_path\"\nto_Pa = [25, 50, 100]\n").doubts;
  REQUIRE(path.size() == 1);
  CHECK_THAT(path[0], Contains("to_Pa") && Contains("kPa"));
  CHECK_THAT(with_units(usual_compression + "[calibrate]\npressures_Pa = [10, 20]\n").doubts.at(0),
             Contains("calibrate.pressures_Pa"));
  CHECK_THAT(with_units(usual_compression, {"material.friction=30"}).doubts.at(0), Contains("friction = 30"));
}

TEST_CASE("a test with which the grains of its specimen would overlap by their radius is refused by the stiffness") {
  const Specimen specimen = reference_specimen("dense_p20");
  CHECK(protocol::unusual_in(with_units(usual_compression), specimen).empty());
  CHECK_THROWS_WITH(protocol::with_overrides(with_units(usual_compression, {"material.young_modulus_Pa=70"}), specimen),
                    Contains("young_modulus_Pa = 70") && Contains("GPa"));
  // The largest pressure counts, of any stage.
  const std::string far = "[[stage]]\nkind = \"pressure_path\"\nto_Pa = [25e3, 5e9]\n";
  CHECK_THROWS_WITH(protocol::with_overrides(with_units(far), specimen), Contains("largest pressure of the test"));
  // What a specimen brings with it, unless the protocol has told the key.
  Specimen rough = specimen;
  for (Material& material : rough.materials) material.friction = 28;
  CHECK_THAT(protocol::unusual_in(with_units(usual_compression), rough).at(0), Contains("friction = 28"));
  CHECK(protocol::unusual_in(with_units(usual_compression, {"material.friction=29"}), rough).size() == 1);
  CHECK(protocol::unusual_in(with_units(usual_compression, {"material.friction=0.5"}), rough).empty());
}
