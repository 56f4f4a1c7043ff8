// `rvelab run` and `rvelab calibrate` as a user meets them: what they print, what they write, how they fail.
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "tests/catch.hpp"
#include "tests/io/record_files.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;
namespace fs = std::filesystem;

namespace {

struct Outcome {
  int code;
  std::string text;  ///< standard output and standard error
};

Outcome rvelab_program(const std::string& arguments) {
  FILE* pipe = popen((std::string(RVELAB_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
  REQUIRE(pipe != nullptr);
  Outcome outcome{0, ""};
  std::array<char, 4096> buffer;
  for (std::size_t got; (got = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    outcome.text.append(buffer.data(), got);
  }
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

/// A folder of its own, removed at the end, with the specimen in it.
struct SpecimenFolder {
  fs::path path;
  explicit SpecimenFolder(const std::string& name) : path(fs::temp_directory_path() / ("rvelab_test_" + name)) {
    fs::remove_all(path);
    fs::create_directories(path);
    io::write_specimen(reference_specimen("dense_p20"), specimen());
  }
  ~SpecimenFolder() { fs::remove_all(path); }
  std::string specimen() const { return (path / "S.h5").string(); }
  std::string file(const std::string& name) const { return (path / name).string(); }
};

const std::string biaxial_file = RVELAB_SOURCE_DIR "/protocols/biaxial.toml";

void expect_users_mistake(const Outcome& outcome, const std::string& part) {
  INFO(outcome.text);
  CHECK(outcome.code == 2);
  CHECK(std::count(outcome.text.begin(), outcome.text.end(), '\n') == 1);
  CHECK(outcome.text.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("A run prints its records as arrays by name and writes the same ones") {
  const SpecimenFolder folder("run");
  const Outcome outcome =
      rvelab_program("run " + biaxial_file + " --specimen " + folder.specimen() + " -o " + folder.file("R.h5") +
                     " --set stage.compression.to_strain=0.002 --set stage.isotropic.stress_tolerance=1e-3 --json");
  INFO(outcome.text);
  REQUIRE(outcome.code == 0);
  const auto printed = nlohmann::json::parse(outcome.text);
  CHECK(printed["records"]["strain"].size() == 5);
  CHECK(printed["pressure_Pa"] == 20e3);
  CHECK(printed["wall_s"].get<double>() > 0);
  CHECK(printed["grain_steps"].get<double>() > 0);
  const records::TestResult written = test::read_records(folder.file("R.h5"));
  REQUIRE(written.records.size() == 5);
  for (std::size_t k = 0; k < 5; ++k) {
    CHECK(printed["records"]["strain"][k].get<double>() == written.records[k].strain);
    CHECK(printed["records"]["void_ratio"][k].get<double>() == written.records[k].void_ratio);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        CHECK(printed["records"]["stress_Pa"][k][i][j].get<double>() == written.records[k].stress(i, j));
      }
    }
  }
  // The protocol that was run is kept, --set included, and can be run again.
  std::ofstream(folder.file("again.toml")) << test::read_protocol_text(folder.file("R.h5"));
  const Outcome again =
      rvelab_program("run " + folder.file("again.toml") + " --specimen " + folder.specimen() + " --json");
  INFO(again.text);
  REQUIRE(again.code == 0);
  CHECK(nlohmann::json::parse(again.text)["records"] == printed["records"]);
}

TEST_CASE("A specimen that the protocol names lies beside it") {
  const SpecimenFolder folder("named");
  std::ofstream(folder.file("rest.toml")) << "[test]\nname = \"rest\"\n[specimen]\nfile = \"S.h5\"\n"
                                             "[[stage]]\nkind = \"relax\"\n";
  CHECK(rvelab_program("run " + folder.file("rest.toml")).code == 0);
}

TEST_CASE("A calibration prints the words that other programs read and writes one record file a pressure") {
  const SpecimenFolder folder("calibrate");
  const Outcome outcome =
      rvelab_program("calibrate " + biaxial_file + " --specimen " + folder.specimen() +
                     " --pressures 15e3,20e3 --set stage.compression.to_strain=0.003 --threads 2 -o " +
                     folder.path.string() + " --json");
  INFO(outcome.text);
  REQUIRE(outcome.code == 0);
  const auto printed = nlohmann::json::parse(outcome.text);
  for (const char* key : {"friction_angle_deg", "friction_angle_moving_mean_deg", "friction_angle_with_cohesion_deg",
                          "cohesion_Pa", "large_strain_friction_angle_deg", "bearing_capacity_Nq", "local_shear_Nq",
                          "wedge_angle_deg", "per_pressure"}) {
    INFO(key);
    CHECK(printed.contains(key));
  }
  // A test to 0.3 % knows nothing of 12 %, nor of a window of 1 %.
  CHECK(printed["large_strain_friction_angle_deg"].is_null());
  CHECK(printed["friction_angle_moving_mean_deg"].is_null());
  REQUIRE(printed["per_pressure"].size() == 2);
  CHECK(printed["per_pressure"][0]["pressure_Pa"] == 15e3);
  CHECK(printed["per_pressure"][0]["records"] == 7);
  CHECK(printed["friction_angle_deg"].get<double>() > 15);
  CHECK(test::read_records(folder.file("R_15000.h5")).pressure == 15e3);
  CHECK(test::read_records(folder.file("R_20000.h5")).records.size() == 7);
}

TEST_CASE("A user's mistake is one line on standard error and exit code 2") {
  const SpecimenFolder folder("mistakes");
  const std::string with = " --specimen " + folder.specimen();
  expect_users_mistake(rvelab_program("run no/such.toml" + with), "no/such.toml");
  expect_users_mistake(rvelab_program("run " + biaxial_file), "no specimen");
  expect_users_mistake(rvelab_program("run " + biaxial_file + " --specimen no/such.h5"), "no/such.h5");
  expect_users_mistake(rvelab_program("run " + biaxial_file + with + " --set tets.pressure_Pa=1 --set contact.slop=2"),
                       "nearest known key is contact.slip");
  expect_users_mistake(rvelab_program("run " + biaxial_file + with + " -o no/such/folder/R.h5"), "no/such/folder");
  expect_users_mistake(rvelab_program("run " + biaxial_file + with + " --set material.steel.friction=0.1"), "steel");
  expect_users_mistake(rvelab_program("run " + std::string(RVELAB_SOURCE_DIR) + "/protocols/triaxial.toml" + with),
                       "dimension");
  expect_users_mistake(rvelab_program("calibrate " + biaxial_file + with + " --pressures 10e3,-1"), "-1");
  expect_users_mistake(rvelab_program("calibrate " + biaxial_file + with + " --pressures 10e3,10e3"),
                       "each pressure once");
  expect_users_mistake(rvelab_program("calibrate " + biaxial_file + with + with + with + " --pressures 10e3,20e3"),
                       "3 specimens for 2 pressures");
  expect_users_mistake(rvelab_program("calibrate " + std::string(RVELAB_SOURCE_DIR) + "/protocols/probe.toml" + with +
                                      " --pressures 10e3"),
                       "gives no friction angle");
  expect_users_mistake(rvelab_program("run " + biaxial_file + with + " --threads 0"), "threads");
}

TEST_CASE("A run that fails is one line on standard error and exit code 1") {
  const SpecimenFolder folder("failure");
  const Outcome outcome = rvelab_program(
      "run " + biaxial_file + " --specimen " + folder.specimen() +
      " --set stage.isotropic.max_rounds=1 --set stage.isotropic.max_steps=1 --set test.pressure_Pa=30e3");
  INFO(outcome.text);
  CHECK(outcome.code == 1);
  CHECK(std::count(outcome.text.begin(), outcome.text.end(), '\n') == 1);
  CHECK(outcome.text.find("stage \"isotropic\"") != std::string::npos);
}
