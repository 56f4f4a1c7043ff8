// What a run says at its end.
#include "tests/program.hpp"

using namespace rvelab::test;

TEST_CASE("a run ends with its time, part by part, its grain-steps and what its stresses may err by") {
  const Workplace here;
  here.import_packing("dense_p20");
  const auto told = here.json("run biaxial --specimen S.h5 --set stage.compression.to_strain=0.01 -o R.h5");
  const double wall = told["wall_s"];
  double parts = 0;
  for (const char* part : {"grains", "pairs", "list", "control", "files", "other"}) {
    CAPTURE(part);
    const double seconds = told["time_" + std::string(part) + "_s"];
    CHECK(seconds >= 0);
    parts += seconds;
  }
  CHECK(told["time_grains_s"] > 0);
  CHECK(told["time_pairs_s"] > 0);
  CHECK(told["time_files_s"] > 0);
  CHECK(parts >= 0.5 * wall);
  CHECK(told["grain_steps"] > 0);
  // By default 1 % of the increments and 1e-4 of p are allowed; a held stress is paced otherwise, within per cents of
  // p.
  CHECK(told["mean_error_estimate"] > 1e-5);
  CHECK(told["mean_error_estimate"] < 0.05);
  CHECK(told["largest_error_estimate"] >= told["mean_error_estimate"]);
}

TEST_CASE("a run at a rate makes no estimate, and one that is complete took no time") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string test = "run biaxial --specimen S.h5 --set stage.compression.to_strain=0.001 --json";
  const std::string made = here.succeeds(test + " --set loading.mode=at_rate --set loading.inertial_number=1e-2");
  CHECK(made.find("mean_error_estimate") == std::string::npos);
  CHECK(nlohmann::json::parse(made)["records"]["error_estimate"] == std::vector<double>{0, 0, 0});
  CHECK(made.find("time_pairs_s") != std::string::npos);
  here.succeeds(test + " -o R.h5");
  const std::string again = here.succeeds(test + " -o R.h5 --resume");
  CHECK(again.find("wall_s") != std::string::npos);
  CHECK(again.find("time_pairs_s") == std::string::npos);
}

TEST_CASE("a run says which event ended a stage before its end: undrained, loose discs liquefy") {
  const Workplace here;
  here.import_packing("soft");
  const auto told = here.json("run biaxial_undrained --specimen S.h5 --set test.pressure_Pa=20e3");
  CHECK(told["ended_by"] == std::vector<std::string>{"compression: p_over_first below 0.001"});
  CHECK(told["end_strain"] < 0.1);
}

TEST_CASE("a cell that gets thin is told of before and after the run, flagged in its records, and shown by inspect") {
  const Workplace here;
  here.import_packing("dense_p20");
  here.write("turn.toml",
             "[test]\nname = \"turn\"\n[[stage]]\nkind = \"deformation\"\n"
             "gradients = [[0.9999875, -0.005, 0.005, 0.9999875]]\n");
  here.succeeds("run turn.toml --specimen S.h5 -o T.h5");
  const auto stands = here.json("inspect S.h5");
  const auto turned = here.json("inspect T.h5");
  CHECK(stands["cell_thin"] == false);
  CHECK(turned["shear_until_thin"] > 10);
  CHECK(turned["shear_until_thin"] < 200);
  here.write("shear.toml",
             "[test]\nname = \"shear\"\n[[stage]]\nkind = \"simple_shear\"\nto_strain = 1000\nrecord_every = 1e-3\n"
             "[[stage.until]]\nquantity = \"strain\"\nabove = 1.5e-3\n");
  const Outcome upright = here.run("run shear.toml --specimen S.h5"),
                tilted = here.run("run shear.toml --specimen T.h5");
  REQUIRE(tilted.code == 0);
  CHECK(tilted.errors.find("stage \"simple_shear\": beyond a shear strain of") != std::string::npos);
  CHECK(upright.errors.find("beyond a shear strain") == std::string::npos);

  here.succeeds("import " + std::string(RVELAB_TEST_DATA) + "/nine_discs/grains.csv --cell 0.03,0.03,0.1 --material " +
                std::string(RVELAB_TEST_DATA) + "/nine_discs/soil.toml -o nine.h5");
  const Outcome small = here.run("run shear.toml --specimen nine.h5 --json");
  INFO(small.errors);
  REQUIRE(small.code == 0);
  const auto told = nlohmann::json::parse(small.output);
  CHECK(told["cell_thin"] == 3);
  CHECK(told["records"]["cell_thin"] == std::vector<bool>{true, true, true});
  CHECK(small.errors.find("3 of 3 records are of a thin cell (cell_thin)") != std::string::npos);
}

TEST_CASE("a cell that pure shear makes low is told of, one that stays high is not") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string test =
      "run pure.toml --specimen S.h5 --set solver.relative_tolerance=1 --set solver.max_overlap_ratio=1";
  here.write("pure.toml",
             "[test]\nname = \"pure shear\"\n[[stage]]\nkind = \"compression\"\nlateral = \"constant_volume\"\n"
             "to_strain = 0.6\nrecord_every = 0.05\n");
  const Outcome low = here.run(test), high = here.run(test + " --set stage.compression.to_strain=0.2");
  INFO(low.errors << high.errors);
  REQUIRE(low.code == 0);
  REQUIRE(high.code == 0);
  CHECK(low.errors.find("the cell became ") != std::string::npos);
  CHECK(low.errors.find("of a thin cell") == std::string::npos);
  CHECK(high.errors.find("the cell became ") == std::string::npos);
}
