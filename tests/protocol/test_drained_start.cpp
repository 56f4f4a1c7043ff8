// A stage that holds a stress starts from it, as a drained test starts from the consolidated specimen; and it holds
// what it says from its first increment on.
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/protocol/run.hpp"
#include "tests/catch.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

/// On a specimen at rest at 20 kPa.
protocol::TestRun run_at(const std::string& pressure, const std::string& stages) {
  const std::string text = "[test]\nname = \"test\"\npressure_Pa = " + pressure + "\n" + stages;
  return protocol::run_protocol(protocol::parse_protocol(text, "t.toml"), reference_specimen("dense_p20"));
}

const std::string drained[] = {
    "[[stage]]\nkind = \"compression\"\nto_strain = 0.002\n",
    "[[stage]]\nkind = \"compression\"\nto_strain = -0.002\n",
    "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.004\nnormal = \"constant_stress\"\n",
    "[[stage]]\nkind = \"deviatoric\"\nto_strain = 0.004\n",
};

}  // namespace

TEST_CASE("a drained stage far from the stress that it holds is refused before its first record, with the remedy") {
  for (const std::string& stage : drained) {
    CAPTURE(stage);
    CHECK_THROWS_AS(run_at("30e3", stage), InputError);
    CHECK_THROWS_WITH(run_at("30e3", stage), Contains("where it starts, and it holds 30000 Pa") &&
                                                 Contains("allowed: within 1500 Pa") && Contains("\"isotropic\""));
    CHECK_THROWS_AS(run_at("10e3", stage), InputError);
    // From the consolidated state, whether it was prepared so or brought there, it runs.
    CHECK(run_at("20e3", stage).complete);
    CHECK(run_at("30e3", "[[stage]]\nkind = \"isotropic\"\n" + stage).complete);
    CHECK(run_at("30e3", "[[stage]]\nkind = \"pressure_path\"\nto_Pa = [30e3]\n" + stage).complete);
  }
  // What holds no stress starts from any.
  CHECK(run_at("30e3", "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.002\n").complete);
}

TEST_CASE("a drained stage after an undrained one is refused where that left another stress") {
  CHECK_THROWS_WITH(run_at("20e3",
                           "[[stage]]\nname = \"undrained\"\nkind = \"compression\"\nto_strain = 0.02\n"
                           "lateral = \"constant_volume\"\n[[stage]]\nname = \"drained\"\nkind = \"compression\"\n"
                           "to_strain = 0.001\n"),
                    Contains("stage \"drained\": -sigma_xx = "));
}

TEST_CASE("deviatoric loading holds p from its first increment on, though it starts a little beside it") {
  const protocol::TestRun run = run_at("20.6e3", "[[stage]]\nkind = \"deviatoric\"\nto_strain = 0.01\n");
  REQUIRE(run.result.records.size() == 11);
  CHECK(mean_pressure(run.result.records[0].stress, 2) == Approx(20e3).epsilon(1e-3));
  for (std::size_t k = 1; k < run.result.records.size(); ++k) {
    CAPTURE(k);
    REQUIRE(run.result.records[k].target_held);
    CHECK(mean_pressure(run.result.records[k].stress, 2) == Approx(20.6e3).epsilon(0.0051));
  }
}
