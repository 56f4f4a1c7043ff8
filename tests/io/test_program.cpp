// The program: words and exit codes that others rely on. 0 done, 1 the run failed, 2 a user's mistake with one line on
// standard error.
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "random_specimen.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/io/version.hpp"
#include "tests/catch.hpp"
#include "tests/io/record_files.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

struct Outcome {
  int code;
  std::string output, errors;
};

Outcome run(const Folder& folder, const std::string& arguments) {
  const std::string command =
      std::string(RVELAB_PROGRAM) + " " + arguments + " >" + (folder / "out") + " 2>" + (folder / "err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(folder / "out"), bytes_of(folder / "err")};
}

void expect_mistake(const Outcome& outcome, const std::string& word) {
  CHECK(outcome.code == 2);
  CHECK(outcome.output.empty());
  CHECK_THAT(outcome.errors, StartsWith("rvelab: ") && Contains(word));
  CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
  CHECK(outcome.errors.back() == '\n');
}

std::string files(const std::string& name) {
  const std::string stem = std::string(RVELAB_TEST_DATA) + "/yade/" + name;
  return stem + ".particles.csv " + stem + ".contacts.csv " + stem + ".json ";
}

}  // namespace

TEST_CASE("the program names its version and its help, and that is no mistake") {
  const Folder folder;
  const Outcome version_asked = run(folder, "--version");
  CHECK(version_asked.code == 0);
  CHECK(version_asked.output == std::string("rvelab ") + io::version + "\n");
  CHECK(run(folder, "--help").code == 0);
  CHECK_THAT(run(folder, "import --help").output, Contains("PARTICLES.csv") && Contains("Examples"));
}

TEST_CASE("a user's mistake is one line on standard error and exit code 2") {
  const Folder folder;
  CHECK(run(folder, "").code == 2);
  expect_mistake(run(folder, "inspct x.h5"), "nearest is inspect");
  expect_mistake(run(folder, "inspect"), "required");
  expect_mistake(run(folder, "inspect a.h5 --jsn"), "--jsn");
  expect_mistake(run(folder, "inspect none.h5"), "none.h5: no such file");
  expect_mistake(run(folder, "import p.csv -o " + (folder / "s.h5")), "p.csv: no such file");
  expect_mistake(run(folder, "import p.csv --cell 1,2 -o s.h5"), "--cell");
  expect_mistake(run(folder, "import m.json -o s.h5"), "PARTICLES.csv");
  expect_mistake(run(folder, "import " + files("dense") + "--set contact.slp=1 -o " + (folder / "s.h5")),
                 "contact.slip");
  write_bytes(folder / "m.toml", "[contat]\n[solver]\nskn = 1\n");
  const Outcome two = run(folder, "import " + files("dense") + "--material " + (folder / "m.toml") + " -o s.h5");
  expect_mistake(two, "m.toml:1");
  CHECK_THAT(two.errors, Contains("m.toml:3") && Contains("solver.skin"));
  CHECK(!std::filesystem::exists(folder / "s.h5"));
}

TEST_CASE("an imported packing, inspected, has the stress, void ratio and coordination number that were recorded") {
  const Folder folder;
  for (const std::string name : {"dense", "hertz"}) {
    CAPTURE(name);
    const std::string file = folder / (name + ".h5");
    const Outcome imported =
        run(folder, "import --set contact.slip=full_radius_ratcheting " + files(name) + "-o " + file);
    CAPTURE(imported.errors);
    REQUIRE(imported.code == 0);
    const Outcome inspected = run(folder, "inspect " + file + " --json");
    REQUIRE(inspected.code == 0);
    CHECK(inspected.errors.empty());
    const auto found = nlohmann::json::parse(inspected.output);
    const auto recorded = nlohmann::json::parse(bytes_of(std::string(RVELAB_TEST_DATA) + "/yade/" + name + ".json"));
    const auto dimension = recorded["dim"].get<std::size_t>();
    REQUIRE(found["stress_Pa"].size() == 3);
    for (std::size_t k = 0; k < dimension; ++k) {
      for (std::size_t l = 0; l < dimension; ++l) {
        const double stress = recorded["stress_tension_positive_Pa"][k][l];
        CHECK(std::abs(found["stress_Pa"][k][l].get<double>() - stress) < 1e-6);
        CHECK(found["lattice_m"][k][l] == recorded["hSize_columns_are_cell_vectors"][k][l]);
        CHECK(found["rotation"][k][l] == (k == l ? 1.0 : 0.0));
      }
    }
    CHECK(found["void_ratio"].get<double>() == Approx(recorded["void_ratio"].get<double>()).epsilon(1e-12));
    CHECK(found["coordination_number"] == recorded["coordination_number"]);
    CHECK(found["unbalanced_force_ratio"].get<double>() < 1e-8);
    CHECK(found["p_Pa"].get<double>() == Approx(1e5).epsilon(1e-4));
    CHECK(found["contacts"] == recorded["n_contacts"]);
    CHECK(found["grains"] == recorded["n_particles"]);
    CHECK(found["dimension"] == dimension);
    CHECK(found["slip"] == "full_radius_ratcheting");
    CHECK(found["fabric_anisotropy"].is_number());
    CHECK(found["sliding_fraction"].is_number());
    CHECK_THAT(run(folder, "inspect " + file).output, Contains("stress_Pa") && Contains(" Pa\n"));
  }
}

TEST_CASE("a record file, inspected, tells its protocol and shows its end state; NaN is null") {
  const Folder folder;
  REQUIRE(run(folder, "import " + files("dense") + "-o " + (folder / "s.h5")).code == 0);
  records::TestResult result;
  result.protocol = "biaxial";
  result.stages = {"shear"};
  result.records.resize(12);
  Specimen end = io::read_specimen(folder / "s.h5");
  test::write_records(result, end, "", folder / "r.h5");
  const auto found = nlohmann::json::parse(run(folder, "inspect --json " + (folder / "r.h5")).output);
  CHECK(found["kind"] == "records");
  CHECK(found["records"] == 12);
  CHECK(found["protocol"] == "biaxial");
  CHECK(found["grains"] == 400);

  end.grains.radius.assign(end.grains.size(), 1e-5);  // nothing touches: no fabric
  end.contacts.clear();
  io::write_specimen(end, folder / "loose.h5");
  const auto loose = nlohmann::json::parse(run(folder, "inspect --json " + (folder / "loose.h5")).output);
  CHECK(loose["contacts"] == 0);
  CHECK(loose["fabric_anisotropy"].is_null());
}
