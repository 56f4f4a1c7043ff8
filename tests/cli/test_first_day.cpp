// What a first day stumbles over: units, per cent, misspelt keys, a test that liquefies.
#include <cmath>
#include <sstream>

#include "tests/program.hpp"

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
  const auto json = here.json(test + "1 --set stage.cycles.reverse_at_Pa=500");
  CHECK(json["liquefied"] == false);
  CHECK(json["cycles"] == 1);
  CHECK(json["stress_ratio"].get<double>() == Approx(500.0 / 20e3).epsilon(1e-3));
  const auto far = here.json(test + "40 --set stage.cycles.reverse_at_Pa=4e3 --set stage.cycles.to_strain=0.02");
  REQUIRE(far["liquefied"] == true);
  CHECK(far["least_p_over_first"].get<double>() < 0.02);
  CHECK(far["ended_by"].size() == 1);
}

TEST_CASE("A calibration by drained simple shear gives its angle") {
  const Workplace here;
  here.import_packing("dense_p20");
  const auto found =
      here.json("calibrate simple_shear_drained --specimen S.h5 --pressures 20e3 --set stage.shear.to_strain=0.05");
  CHECK(found["friction_angle_deg"].get<double>() > 15);
  CHECK(found["friction_angle_deg"].get<double>() < 45);
  CHECK(found["large_strain_friction_angle_deg"].is_null());  // not sheared to 1
  here.refuses("calibrate simple_shear --specimen S.h5 --pressures 20e3", "normal = \"constant_stress\"");
}

TEST_CASE("A key is sought by its meaning, and a per cent or a millimetre by what it must be") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string run = "run biaxial --specimen S.h5 ";
  here.refuses(run + "--set contact.frction=0.5", "nearest", "material.friction");
  here.refuses(run + "--set contact.slop=consistent", "nearest", "contact.slip");
  here.refuses(run + "--set pack.number=4", "--set pack.number=4: unknown key pack; it is of recipes, for rvelab pack");
  const Outcome far_off = here.run(run + "--set zzqxzz.key=1");
  CHECK(far_off.code == 2);
  CHECK_THAT(far_off.errors, Contains("unknown key zzqxzz; ") && !Contains("nearest"));
  here.refuses(run + "--set stage.compression.to_strain=10", "if per cent was meant, write 0.1");
  here.refuses(run + "--set damping.local=30", "if per cent was meant, write 0.3");
  here.write("far.csv", "id,x,y,r\n0,0,0,1\n1,5,5,1\n2,5,0,0.9\n3,0,5,1.1\n");
  here.write("sand.toml", "[[material]]\nyoung_modulus_Pa = 8e8\nstiffness_ratio = 0.5\nfriction = 0.5\n");
  const Outcome far = here.run("import far.csv --cell 10,10,0.1 --material sand.toml -o far.h5");
  CHECK(far.code == 0);
  CHECK_THAT(far.errors, Contains("if millimetres were meant"));
  CHECK(here.run("inspect S.h5").errors.empty());
}

TEST_CASE("Several packed specimens are listed, each in one line with its figures") {
  const Workplace here;
  const std::string listed = here.succeeds(
      "pack pack_dense -o S.h5 --count 3 --set pack.number=30 "
      "--set target.void_ratio_tolerance=0.05");
  CHECK_THAT(listed, Contains("void ratio"));
  std::size_t found = 0;
  std::istringstream lines(listed);
  for (std::string line; std::getline(lines, line);) {
    const auto file = line.find("S_" + std::to_string(found + 1) + ".h5");
    if (file == std::string::npos) continue;
    ++found;
    const double void_ratio = here.json("inspect S_" + std::to_string(found) + ".h5")["void_ratio"];
    std::istringstream cells(line);
    bool has_it = false;
    for (std::string cell; cells >> cell;)
      has_it = has_it || std::abs(std::strtod(cell.c_str(), nullptr) - void_ratio) < 1e-3 * void_ratio;
    CAPTURE(line, void_ratio);
    CHECK(has_it);
  }
  CHECK(found == 3);
}
