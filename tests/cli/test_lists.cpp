// rvelab keys and rvelab protocols, and protocols found by their names.
#include "rvelab/protocol/protocol.hpp"
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

TEST_CASE("keys lists every key with unit, type, default, range and meaning") {
  const Workplace here;
  const auto list = here.json("keys")["keys"];
  REQUIRE(list.size() == rvelab::protocol::all_keys().size());
  for (const auto& key : list) {
    CAPTURE(key.dump());
    for (const char* member : {"key", "table", "name", "unit", "type", "range", "meaning"}) {
      CHECK(!key[member].get<std::string>().empty());
    }
    CHECK(key["required"].is_boolean());
    CHECK(key.contains("default"));
  }
  CHECK(list[0]["key"] == "test.name");
}

TEST_CASE("keys takes a part of a key, whatever its case, and says when there is none") {
  const Workplace here;
  const std::string text = here.run("keys PRESSURE").output;
  CHECK_THAT(text, StartsWith("test.pressure_Pa ") && Contains("0 to 1e+15") && Contains("1e+09 Pa") &&
                       Contains("no default") && Contains("stage.isotropic.pressure_Pa") &&
                       Contains("default (test.pressure_Pa)"));
  CHECK(text.find("friction") == std::string::npos);
  CHECK(here.json("keys stage.probe")["keys"].size() == 3);
  here.refuses("keys contact.slop", "nearest", "contact.slip");
}

TEST_CASE("protocols lists the installed ones with what they are, and prints one as it is") {
  const Workplace here;
  const auto list = here.json("protocols");
  std::size_t sources = 0;
  for (const char* folder : {RVELAB_SOURCE_DIR "/protocols", RVELAB_SOURCE_DIR "/protocols/soils"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() != ".toml") continue;  // studies, README
      const std::string name = entry.path().stem().string();
      CAPTURE(name);
      CHECK(list.contains(name));
      CHECK(here.run("protocols " + name).output == bytes_of(entry.path().string()));
      ++sources;
    }
  }
  CHECK(list.size() == sources);
  CHECK(list["biaxial"] == "Drained biaxial compression (2D)");
  CHECK_THAT(here.run("protocols").output, Contains("\ntriaxial ") && Contains(" Drained triaxial compression (3D)\n"));
}

TEST_CASE("a name without separator and .toml is an installed protocol, anything else a path") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string short_test = " --specimen S.h5 --set stage.compression.to_strain=0.001 --json";
  const std::string by_name = here.succeeds("run biaxial" + short_test);
  const std::string by_path = here.succeeds("run " RVELAB_SOURCE_DIR "/protocols/biaxial.toml" + short_test);
  CHECK(nlohmann::json::parse(by_name)["records"] == nlohmann::json::parse(by_path)["records"]);
  here.succeeds("calibrate biaxial --pressures 15e3,20e3" + short_test);

  here.refuses("run biaxail --specimen S.h5", "\"biaxail\"", "nearest is biaxial", "biaxial_extension");
  here.refuses("run biaxial.toml --specimen S.h5", "biaxial.toml: no such file");
  here.refuses("run ./biaxial --specimen S.h5", "./biaxial: no such file");
}

TEST_CASE("the program finds its protocols from where it is, and says when they are not there") {
  const Workplace here;
  namespace fs = std::filesystem;
  fs::create_directories(here / "moved/bin");
  fs::copy_file(RVELAB_PROGRAM, here / "moved/bin/rvelab");
  const std::string moved = here / "moved/bin/rvelab";
  expect_mistake(here.run("run biaxial", moved), "\"biaxial\"", "none");
  for (const char* command : {"protocols", "protocols --json", "protocols biaxial"}) {
    CAPTURE(command);
    const Outcome none = here.run(command, moved);
    expect_one_line(none, 1, "moved/share/rvelab/protocols: no protocols");
    CHECK(none.output.empty());
  }
  fs::create_directories(here / "moved/share/rvelab/protocols");
  fs::copy_file(RVELAB_SOURCE_DIR "/protocols/probe.toml", here / "moved/share/rvelab/protocols/mine.toml");
  CHECK_THAT(here.run("protocols", moved).output, Contains("mine  The elastic stiffness of a specimen"));
  fs::create_symlink(moved, here / "linked");
  CHECK_THAT(here.run("protocols", here / "linked").output, Contains("mine  "));
}

TEST_CASE("where /proc is not mounted the program finds its protocols, by whatever path it was called") {
  namespace fs = std::filesystem;
  const Workplace here;
  const auto called = [&](const std::string& how, const std::string& arguments) {
    return here.run("-c '" + how + " " + arguments + "'", "/bin/sh");
  };
  const std::string listed = here.run("protocols").output;
  const fs::path folder = fs::path(RVELAB_PROGRAM).parent_path();
  fs::create_symlink(RVELAB_PROGRAM, here / "linked");
  fs::create_directory_symlink(folder, here / "folder");
  const std::string shim = "LD_PRELOAD=" RVELAB_FAULT_SHIM " RVELAB_FAULT=\"proc 1 unmounted\" ";
  for (const std::string& how : {shim + RVELAB_PROGRAM, shim + "./linked", shim + "folder/rvelab",
                                 "PATH=" + folder.string() + ":$PATH; " + shim + "rvelab"}) {
    CAPTURE(how);
    const Outcome outcome = called(how, "protocols");
    CHECK(outcome.errors.empty());
    CHECK(outcome.output == listed);
  }
  fs::create_directories(here / "moved/bin");
  fs::copy_file(RVELAB_PROGRAM, here / "moved/bin/rvelab");
  const Outcome none = called(shim + "moved/bin/rvelab", "protocols");
  expect_one_line(none, 1, "moved/share/rvelab/protocols: no protocols");
}
