// How the program answers: help with examples, the nearest word to a misspelt one, one line for each mistake.
#include <sstream>
#include <vector>

#include "tests/cli/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// Subcommands as the program's own help lists them.
std::vector<std::string> subcommands(const Workplace& here) {
  std::istringstream help(here.run("--help").output);
  std::vector<std::string> names;
  bool listing = false;
  for (std::string line; std::getline(help, line);) {
    if (line.starts_with("Subcommands:")) {
      listing = true;
    } else if (listing && line.starts_with("  ")) {
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    } else {
      listing = false;
    }
  }
  return names;
}

}  // namespace

TEST_CASE("without arguments the program shows its short help and exits with 2") {
  const Workplace here;
  const Outcome outcome = here.run("");
  CHECK(outcome.code == 2);
  CHECK(outcome.output.empty());
  CHECK_THAT(outcome.errors, Contains("Subcommands:") && Contains("--help") && Contains("rvelab pack"));
}

TEST_CASE("every subcommand has a help with an example of itself, and no colours") {
  const Workplace here;
  const auto names = subcommands(here);
  CHECK(!names.empty());
  for (const auto& name : names) {
    CAPTURE(name);
    const Outcome outcome = here.run(name + " --help");
    CHECK(outcome.code == 0);
    CHECK(outcome.errors.empty());
    CHECK_THAT(outcome.output, Contains("Example") && Contains("\n  rvelab " + name));
    CHECK(outcome.output.find('\033') == std::string::npos);
    std::istringstream text(outcome.output);
    for (std::string line; std::getline(text, line);) CHECK(line.size() <= 130);
  }
}

TEST_CASE("a misspelt subcommand or option is answered with the nearest one") {
  const Workplace here;
  expect_mistake(here.run("calibrat biaxial"), "unknown subcommand calibrat; the nearest is calibrate; allowed: ");
  expect_mistake(here.run("run biaxial --speciment S.h5"),
                 "run: unknown option --speciment; the nearest is --specimen;");
  expect_mistake(here.run("run biaxial --speciment=S.h5"), "unknown option --speciment; the nearest is --specimen;");
  expect_mistake(here.run("import a.csv --materiel m.toml"), "the nearest is --material;");
  expect_mistake(here.run("compare a.h5 b.h5 --jason"), "the nearest is --json; allowed: --help, --json;");
  expect_mistake(here.run("probe a.h5 --siez 1e-7"), "the nearest is --size;");
  expect_mistake(here.run("probe a.h5 -s 1e-7"), "unknown option -s; allowed: ");
  expect_mistake(here.run("--versoin"), "unknown option --versoin; the nearest is --version;");
}

TEST_CASE("a key or a name that is near nothing is answered with none, a word of a key with that key") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string test = "run biaxial --specimen S.h5 --set ";
  for (const char* far : {"solver.gravity=9.81", "material.colour=3", "contact.zzzz=1"}) {
    const Outcome outcome = here.run(test + far);
    expect_mistake(outcome, "no known key is near; rvelab keys lists them");
    CHECK_THAT(outcome.errors, !Contains("nearest"));
  }
  expect_mistake(here.run(test + "solver.tolerance=0.1"), "the nearest known key is solver.relative_tolerance;");
  expect_mistake(here.run(test + "material.sand.frictoin=0.1"), "the nearest known key is material.sand.friction;");
  expect_mistake(here.run(test + "stage.compression.lateral=zzzz"), "choose one of these");
  for (const char* words : {"run zzzz --specimen S.h5", "keys qqqq"})
    CHECK_THAT(here.run(words).errors, !Contains("nearest"));
}

TEST_CASE("a value that looks like an option belongs to the option before it") {
  const Workplace here;
  expect_mistake(here.run("inspect -x.h5"), "unknown option -x");
  expect_mistake(here.run("run biaxial --specimen --none.h5"), "--none.h5: no such file");
  expect_mistake(here.run("probe none.h5 --size -1e-7"), "none.h5");
}

TEST_CASE("what is missing is said with an example of the subcommand") {
  const Workplace here;
  expect_mistake(here.run("import"), "import: PARTICLES.csv is required; write for example: rvelab import ");
  expect_mistake(here.run("import a.csv"), "--output is required; write for example: rvelab import ");
  expect_mistake(here.run("run"), "run: protocol is required; write for example: rvelab run biaxial ");
  expect_mistake(here.run("compare a.h5"), "compare: B.h5 is required; write for example: rvelab compare ");
  expect_mistake(here.run("export a.h5 -o b"), "export: --format is required; write for example: rvelab export ");
  expect_mistake(here.run("run biaxial --set"), "run: --set");
  expect_mistake(here.run("run biaxial --threads many"), "--threads");
  expect_mistake(here.run("probe a.h5 --method guess"), "guess not in");
  expect_mistake(here.run("probe a.h5 b.h5"), "b.h5; write for example: rvelab probe ");
}

TEST_CASE("all mistakes of a protocol and its assignments come at once, in the order of the lines, assignments last") {
  const Workplace here;
  here.import_packing("dense_p20");
  std::ofstream(here / "t.toml") << "[test]\nname = \"t\"\npressure_kPa = 20\n[contact]\nslop = 1\n"
                                    "[[stage]]\nkind = \"isotropic\"\nunbalanced = inf\n";
  const Outcome outcome =
      here.run("run t.toml --specimen S.h5 --set solver.skin=nan --set nonsense --set stage.isotropic.max_steps=1.5");
  expect_mistake(outcome, "");
  const std::vector<std::string> parts{
      "t.toml:3: test.pressure_kPa is not known; write test.pressure_Pa, 1 kPa = 1000 Pa",
      "t.toml:5: unknown key contact.slop; the nearest known key is contact.slip",
      "t.toml:8: stage.isotropic.unbalanced = inf is not finite; allowed: ",
      "t.toml: --set nonsense is not an assignment",
      "t.toml: --set solver.skin=nan: solver.skin = nan is not finite; allowed: above 0 to 10; give a finite number",
      "t.toml: --set stage.isotropic.max_steps=1.5: stage.isotropic.max_steps = 1.5 is not a whole number"};
  std::size_t at = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    CAPTURE(parts[k], outcome.errors);
    const auto found = outcome.errors.find(parts[k]);
    REQUIRE(found != std::string::npos);
    CHECK(found >= at);
    at = found;
  }
  for (std::size_t k = 4; k < parts.size(); ++k) {
    CAPTURE(parts[k], outcome.errors);
    CHECK(outcome.errors.find(parts[k]) > outcome.errors.find(parts[2]));
    CHECK(outcome.errors.find(parts[k]) != std::string::npos);
  }
  CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '|') == 5);
}

TEST_CASE("every mistake of the assignments of an import comes at once") {
  const Workplace here;
  const std::string stem = std::string(RVELAB_TEST_DATA) + "/yade/dense";
  const Outcome outcome =
      here.run("import " + stem + ".particles.csv " + stem + ".json -o S.h5 --set contact.slop=1 " +
               "--set solver.skin=0.2 --set material.young_modulus_MPa=800 --set damping.local=nan");
  expect_mistake(outcome, "unknown key contact.slop; the nearest known key is contact.slip");
  CHECK_THAT(outcome.errors, Contains(" | material.young_modulus_MPa is not known; write material.young_modulus_Pa, "
                                      "1 MPa = 1e6 Pa | damping.local = nan is not finite"));
  CHECK(!std::filesystem::exists(here / "S.h5"));
}
