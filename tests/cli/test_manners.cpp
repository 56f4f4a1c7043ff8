// How the program answers: help with examples, the nearest word to a misspelt one, one line for each mistake.
#include <sstream>
#include <vector>

#include "tests/program.hpp"

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

/// One line that names so many mistakes, in this order; of each its words.
void expect_mistakes(const Outcome& outcome, const std::vector<std::vector<std::string>>& mistakes) {
  expect_mistake(outcome);
  std::vector<std::string> said;
  std::istringstream line(outcome.errors);
  for (std::string one; std::getline(line, one, '|');) said.push_back(one);
  REQUIRE(said.size() == mistakes.size());
  for (std::size_t k = 0; k < said.size(); ++k)
    for (const std::string& word : mistakes[k]) CHECK_THAT(said[k], Contains(word));
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
  }
}

TEST_CASE("a misspelt subcommand or option is answered with the nearest one") {
  const Workplace here;
  here.refuses("calibrat biaxial", "calibrat;", "nearest is calibrate;", "allowed");
  here.refuses("run biaxial --speciment S.h5", "run", "--speciment", "nearest is --specimen;");
  here.refuses("run biaxial --speciment=S.h5", "--speciment", "nearest is --specimen;");
  here.refuses("import a.csv --materiel m.toml", "nearest is --material;");
  here.refuses("compare a.h5 b.h5 --jason", "nearest is --json;", "--help, --json");
  here.refuses("probe a.h5 --siez 1e-7", "nearest is --size;");
  here.refuses("probe a.h5 -s 1e-7", "unknown option -s; allowed: ");
  here.refuses("--versoin", "--versoin", "nearest is --version;");
}

TEST_CASE("a key or a name that is near nothing is answered with none, a word of a key with that key") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string test = "run biaxial --specimen S.h5 --set ";
  for (const char* far : {"solver.gravity=9.81", "material.colour=3", "contact.zzzz=1"}) {
    const Outcome outcome = here.run(test + far);
    expect_mistake(outcome, "rvelab keys");
    CHECK_THAT(outcome.errors, !Contains("nearest"));
  }
  here.refuses(test + "solver.tolerance=0.1", "nearest", "solver.relative_tolerance");
  here.refuses(test + "material.sand.frictoin=0.1", "nearest", "material.sand.friction");
  here.refuses(test + "stage.compression.lateral=zzzz", "choose one of these");
  for (const char* words : {"run zzzz --specimen S.h5", "keys qqqq"})
    CHECK_THAT(here.run(words).errors, !Contains("nearest"));
}

TEST_CASE("a value that looks like an option belongs to the option before it") {
  const Workplace here;
  here.refuses("inspect -x.h5", "unknown option -x");
  here.refuses("run biaxial --specimen --none.h5", "--none.h5: no such file");
  here.refuses("probe none.h5 --size -1e-7", "none.h5");
}

TEST_CASE("what is missing is said with an example of the subcommand") {
  const Workplace here;
  here.refuses("import", "PARTICLES.csv is required", "rvelab import ");
  here.refuses("import a.csv", "--output is required", "rvelab import ");
  here.refuses("run", "protocol is required", "rvelab run biaxial ");
  here.refuses("compare a.h5", "B.h5 is required", "rvelab compare ");
  here.refuses("export a.h5 -o b", "--format is required", "rvelab export ");
  here.refuses("run biaxial --set", "run: --set");
  here.refuses("run biaxial --threads many", "--threads");
  here.refuses("probe a.h5 --method guess", "guess not in");
  here.refuses("probe a.h5 b.h5", "b.h5", "rvelab probe ");
}

TEST_CASE("all mistakes of a protocol and its assignments come at once, in the order of the lines, assignments last") {
  const Workplace here;
  here.import_packing("dense_p20");
  here.write("t.toml",
             "[test]\nname = \"t\"\npressure_kPa = 20\n[contact]\nslop = 1\n"
             "[[stage]]\nkind = \"isotropic\"\nunbalanced = inf\n");
  expect_mistakes(
      here.run("run t.toml --specimen S.h5 --set solver.skin=nan --set nonsense --set stage.isotropic.max_steps=1.5"),
      {{"t.toml:3: ", "test.pressure_kPa", "test.pressure_Pa", "1000 Pa"},
       {"t.toml:5: ", "contact.slop", "nearest", "contact.slip"},
       {"t.toml:8: ", "stage.isotropic.unbalanced = inf", "allowed: "},
       {"t.toml: --set nonsense", "table.key=value"},
       {"t.toml: --set solver.skin=nan", "solver.skin = nan", "allowed: above 0 to 10"},
       {"t.toml: --set stage.isotropic.max_steps=1.5", "max_steps = 1.5", "whole number"}});
}

TEST_CASE("every mistake of the assignments of an import comes at once") {
  const Workplace here;
  const std::string stem = std::string(RVELAB_TEST_DATA) + "/yade/dense";
  expect_mistakes(here.run("import " + stem + ".particles.csv " + stem + ".json -o S.h5 --set contact.slop=1 " +
                           "--set solver.skin=0.2 --set material.young_modulus_MPa=800 --set damping.local=nan"),
                  {{"contact.slop", "nearest", "contact.slip"},
                   {"material.young_modulus_MPa", "material.young_modulus_Pa", "1e6 Pa"},
                   {"damping.local = nan", "allowed: "}});
  CHECK(!std::filesystem::exists(here / "S.h5"));
}
