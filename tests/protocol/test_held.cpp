// What a test at dt = 0 says it holds, it holds: through avalanches, in which the contact network gives way and the
// cell comes apart, and to words where the grains cannot carry it.
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/protocol/run.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

/// A few discs of a sand with rolling friction, at 100 kPa, kn/(p t) = 4e3; with these seeds they collapse on the way.
Specimen sand(int seed) {
  const char* const recipe = R"([pack]
name = "sand"
shape = "disc"
number = 80
thickness_m = 4e-4
[grains]
grading = "tabulated"
passing_by = "mass"
radii_m = [0.10e-3, 0.15e-3, 0.275e-3, 0.31e-3, 0.5e-3]
passing = [0, 0.1, 0.5, 0.6, 1]
[target]
pressure_Pa = 100e3
void_ratio = 0.1874
void_ratio_tolerance = 0.02
[contact]
law = "linear"
rolling = true
[damping]
local = 0.1
[[material]]
name = "sand"
density_kg_m3 = 2650
young_modulus_Pa = 800e6
stiffness_ratio = 0.5
friction_angle_deg = 23
rolling_stiffness = 1
rolling_friction = 0.05
)";
  Workers workers(1);
  return pack::pack(pack::parse_recipe(recipe, "sand.toml", {"pack.seed=" + std::to_string(seed)}).recipe, workers)
      .specimen;
}

protocol::TestRun run(const Specimen& specimen, const std::string& stages) {
  const std::string text =
      "[test]\nname = \"test\"\npressure_Pa = 200e3\n[output]\nquantities = []\n"
      "[[stage]]\nkind = \"isotropic\"\n" +
      stages;
  return protocol::run_protocol(protocol::parse_protocol(text, "t.toml"), specimen);
}

}  // namespace

TEST_CASE("every record of a drained test is of its lateral stress, through avalanches") {
  // Before the target waited, these tests had records at 0.0003 to 0.6 of it.
  for (const int seed : {1, 2, 4}) {
    CAPTURE(seed);
    const protocol::TestRun drained = run(sand(seed), "[[stage]]\nkind = \"compression\"\nto_strain = 0.1\n");
    REQUIRE(drained.result.records.size() == 201);
    double worst = 0;
    long longest = 0;
    for (const records::Record& record : drained.result.records) {
      worst = std::max(worst, std::abs(record.stress(0, 0) / -200e3 - 1));
      longest = std::max(longest, record.substeps);
      CHECK(record.target_held);
    }
    CHECK(worst <= 0.005 * (1 + 1e-9));
    CHECK(drained.costs.waited > 1000);  // an avalanche was there to be waited for
    CHECK(longest < 50'000);  // and closed in less than a cell of stiff grains would need at the last increment
  }
}

TEST_CASE("every record at constant p, and of simple shear under a held stress, is of that stress") {
  const Specimen specimen = sand(4);
  for (const records::Record& record :
       run(specimen, "[[stage]]\nkind = \"deviatoric\"\nto_strain = 0.1\n").result.records)
    CHECK(mean_pressure(record.stress, 2) == Approx(200e3).epsilon(0.0051));
  for (const records::Record& record :
       run(specimen, "[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.1\nnormal = \"constant_stress\"\n")
           .result.records)
    CHECK(record.stress(1, 1) == Approx(-200e3).epsilon(0.0051));
}

TEST_CASE("a stress that the grains cannot carry ends a test in words, after the records that it could") {
  // The axial stress goes to ten times the lateral one: no friction angle of 23 degrees allows more than three or four.
  const std::string path =
      "[[stage]]\nkind = \"path\"\nrecords_per_point = 20\n"
      "[[stage.row]]\nname = \"lateral\"\nstress = {xx = 1}\n"
      "[[stage.row]]\nname = \"axial\"\nstress = {yy = 1}\nto_Pa = [-2e6]\n"
      "[[stage.row]]\nname = \"shear\"\nstrain = {xy = 1}\n";
  try {
    run(sand(1), path);
    FAIL("was held");
  } catch (const IncrementFailed& error) {
    CHECK_THAT(error.what(), Contains("stage \"path\": a held stress is off by") &&
                                 Contains("the grains cannot carry it, for the cell sheared by 0.5"));
  }
}
