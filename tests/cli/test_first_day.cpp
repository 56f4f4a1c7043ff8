// What a first day stumbles over: units, per cent, misspelt keys, a test that liquefies.
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("A cyclic test says after how many cycles it liquefied, or that it did not") {
  const Workplace here;
  here.import_packing("soft_p20");
  const std::string test = "run cyclic_liquefaction --specimen S.h5 --set stage.cycles.cycles=";
  const Outcome none = here.run(test + "1 --set stage.cycles.reverse_at_Pa=500");
  INFO(none.errors);
  REQUIRE(none.code == 0);
  CHECK_THAT(none.output, Contains("liquefaction") && Contains("none: the least p is ") &&
                              Contains("2 % counts as liquefied") && Contains("stress_ratio"));
  const auto json = nlohmann::json::parse(here.run(test + "1 --set stage.cycles.reverse_at_Pa=500 --json").output);
  CHECK(json["liquefied"] == false);
  CHECK(json["cycles"] == 1);
  CHECK(json["stress_ratio"].get<double>() == Approx(500.0 / 20e3).epsilon(1e-3));
  const auto far = nlohmann::json::parse(
      here.run(test + "40 --set stage.cycles.reverse_at_Pa=4e3 --set stage.cycles.to_strain=0.02 --json").output);
  REQUIRE(far["liquefied"] == true);
  CHECK(far["least_p_over_first"].get<double>() < 0.02);
  CHECK(far["ended_by"].size() == 1);
}

TEST_CASE("A calibration by drained simple shear gives its angle") {
  const Workplace here;
  here.import_packing("dense_p20");
  const Outcome outcome = here.run(
      "calibrate simple_shear_drained --specimen S.h5 --pressures 20e3 --json --set stage.shear.to_strain=0.05");
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  const auto found = nlohmann::json::parse(outcome.output);
  CHECK(found["friction_angle_deg"].get<double>() > 15);
  CHECK(found["friction_angle_deg"].get<double>() < 45);
  CHECK(found["large_strain_friction_angle_deg"].is_null());  // not sheared to 1
  expect_mistake(here.run("calibrate simple_shear --specimen S.h5 --pressures 20e3"), "normal = \"constant_stress\"");
}

TEST_CASE("A key is sought by its meaning, and a per cent or a millimetre by what it must be") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string run = "run biaxial --specimen S.h5 ";
  expect_mistake(here.run(run + "--set contact.frction=0.5"), "the nearest known key is material.friction");
  expect_mistake(here.run(run + "--set contact.slop=consistent"), "the nearest known key is contact.slip");
  expect_mistake(here.run(run + "--set pack.number=4"),
                 "--set pack.number=4: unknown key pack; it is of recipes, for rvelab pack");
  const Outcome far_off = here.run(run + "--set zzqxzz.key=1");
  CHECK(far_off.code == 2);
  CHECK_THAT(far_off.errors, Contains("unknown key zzqxzz; ") && !Contains("nearest"));
  expect_mistake(here.run(run + "--set stage.compression.to_strain=10"), "if per cent was meant, write 0.1");
  expect_mistake(here.run(run + "--set damping.local=30"), "if per cent was meant, write 0.3");
  here.write("far.csv", "id,x,y,r\n0,0,0,1\n1,5,5,1\n2,5,0,0.9\n3,0,5,1.1\n");
  here.write("sand.toml", "[[material]]\nyoung_modulus_Pa = 8e8\nstiffness_ratio = 0.5\nfriction = 0.5\n");
  const Outcome far = here.run("import far.csv --cell 10,10,0.1 --material sand.toml -o far.h5");
  CHECK(far.code == 0);
  CHECK_THAT(far.errors, Contains("if millimetres were meant"));
  CHECK(here.run("inspect S.h5").errors.empty());
}

TEST_CASE("Several packed specimens are a table of short lines") {
  const Workplace here;
  const Outcome outcome = here.run(
      "pack pack_dense -o S.h5 --count 3 --set pack.number=30 "
      "--set target.void_ratio_tolerance=0.05");
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  std::istringstream lines(outcome.output);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) CHECK(line.size() <= 120);
  CHECK(count == 5);  // the recipe, the header, three specimens
  CHECK_THAT(outcome.output, Contains("void ratio") && Contains("S_3.h5"));
}
