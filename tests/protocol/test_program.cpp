// `rvelab run` and `rvelab calibrate` as a user meets them: what they print, what they write, how they fail.
#include "rvelab/io/journal/recorded_test.hpp"
#include "tests/io/record_files.hpp"
#include "tests/program.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

const std::string biaxial_file = RVELAB_SOURCE_DIR "/protocols/biaxial.toml ";

/// A folder with a specimen, S.h5.
struct WithSpecimen : Workplace {
  WithSpecimen() { import_packing("dense_p20"); }
};

}  // namespace

TEST_CASE("A run prints its records as arrays by name and writes the same ones") {
  const WithSpecimen here;
  const auto printed = here.json("run " + biaxial_file +
                                 "--specimen S.h5 -o R.h5 --set stage.compression.to_strain=0.002 "
                                 "--set stage.isotropic.stress_tolerance=1e-3");
  CHECK(printed["records"]["strain"].size() == 5);
  CHECK(printed["pressure_Pa"] == 20e3);
  CHECK(printed["wall_s"].get<double>() > 0);
  CHECK(printed["grain_steps"].get<double>() > 0);
  const records::TestResult written = test::read_records(here / "R.h5");
  REQUIRE(written.records.size() == 5);
  for (std::size_t k = 0; k < 5; ++k) {
    CHECK(printed["records"]["strain"][k].get<double>() == written.records[k].strain);
    CHECK(printed["records"]["void_ratio"][k].get<double>() == written.records[k].void_ratio);
    for (int i = 0; i < 9; ++i)
      CHECK(printed["records"]["stress_Pa"][k][i / 3][i % 3].get<double>() == written.records[k].stress(i / 3, i % 3));
  }
  // The protocol that was run is kept, --set included, and can be run again.
  here.write("again.toml", test::read_protocol_text(here / "R.h5"));
  CHECK(here.json("run again.toml --specimen S.h5")["records"] == printed["records"]);
}

TEST_CASE("A specimen that the protocol names lies beside it") {
  const WithSpecimen here;
  here.write("rest.toml", "[test]\nname = \"rest\"\n[specimen]\nfile = \"S.h5\"\n[[stage]]\nkind = \"relax\"\n");
  here.succeeds("run rest.toml");
}

TEST_CASE("A calibration prints the words that other programs read and writes one record file a pressure") {
  const WithSpecimen here;
  const auto printed = here.json("calibrate " + biaxial_file +
                                 "--specimen S.h5 --pressures 15e3,20e3 --set stage.compression.to_strain=0.003 "
                                 "--threads 2 -o .");
  for (const char* key :
       {"friction_angle_moving_mean_deg", "friction_angle_with_cohesion_deg", "cohesion_Pa",
        "large_strain_friction_angle_deg", "bearing_capacity_Nq", "local_shear_Nq", "wedge_angle_deg"}) {
    INFO(key);
    CHECK(printed.contains(key));
  }
  REQUIRE(printed["per_pressure"].size() == 2);
  CHECK(printed["per_pressure"][0]["pressure_Pa"] == 15e3);
  CHECK(printed["per_pressure"][0]["records"] == 7);
  CHECK(printed["friction_angle_deg"].get<double>() > 15);
  CHECK(test::read_records(here / "R_15000.h5").pressure == 15e3);
  CHECK(test::read_records(here / "R_20000.h5").records.size() == 7);
}

TEST_CASE("A user's mistake is one line on standard error and exit code 2") {
  const WithSpecimen here;
  const std::string run = "run " + biaxial_file, with = "--specimen S.h5 ";
  here.refuses("run no/such.toml " + with, "no/such.toml");
  here.refuses(run, "no specimen");
  here.refuses(run + "--specimen no/such.h5", "no/such.h5");
  here.refuses(run + with + "--set tets.pressure_Pa=1 --set contact.slop=2", "tets.pressure_Pa", "contact.slip");
  here.refuses(run + with + "-o no/such/folder/R.h5", "no/such/folder");
  here.refuses(run + with + "--set material.steel.friction=0.1", "steel");
  here.refuses("run " RVELAB_SOURCE_DIR "/protocols/triaxial.toml " + with, "dimension");
  here.refuses(run + with + "--threads 0", "threads");
  const std::string calibrate = "calibrate " + biaxial_file + with;
  here.refuses(calibrate + "--pressures 10e3,-1", "-1");
  here.refuses(calibrate + with + with + "--pressures 10e3,20e3", "3 specimens", "2 pressures");
  here.refuses("calibrate " RVELAB_SOURCE_DIR "/protocols/probe.toml " + with + "--pressures 10e3", "friction angle");
}

TEST_CASE("A run that fails is one line on standard error and exit code 1") {
  const WithSpecimen here;
  expect_one_line(here.run("run " + biaxial_file +
                           "--specimen S.h5 --set stage.isotropic.max_rounds=1 --set stage.isotropic.max_steps=1 "
                           "--set test.pressure_Pa=30e3"),
                  1, "stage \"isotropic\"");
}
