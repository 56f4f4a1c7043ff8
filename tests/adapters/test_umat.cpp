// umat_ as its hosts call it, which umat_hosts.c does; and what its file of materials may hold.
#include <filesystem>

#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

const std::string sources = RVELAB_SOURCE_DIR "/tests/adapters/";
const std::string hosts = RVELAB_UMAT_HOSTS;

/// A folder with a specimen of 64 discs, another of 60 spheres, and the file of materials.
void prepare(const Workplace& here, bool spheres) {
  Outcome packed = here.run("pack pack_dense -o discs.h5 --set pack.number=64 --set target.void_ratio=0.2");
  INFO(packed.errors);
  REQUIRE(packed.code == 0);
  if (spheres) {
    packed = here.run(
        "pack pack_hertz -o spheres.h5 --set pack.number=60 --set target.void_ratio=0.62 --set "
        "target.void_ratio_tolerance=0.05");
    INFO(packed.errors);
    REQUIRE(packed.code == 0);
  }
  std::filesystem::copy_file(sources + "rvelab_umat.toml", here / "rvelab_umat.toml");
}

void expect_served(const std::string& host, bool spheres = false) {
  unsetenv("RVELAB_UMAT");
  const Workplace here;
  prepare(here, spheres);
  here.succeeds(host + " .", hosts);
}

}  // namespace

TEST_CASE("umat_ serves Abaqus: four calls an increment give the stress and tangent of one step") {
  expect_served("abaqus");
}

TEST_CASE("umat_ serves CalculiX: R^T sigma R under finite rotation, on four threads") { expect_served("calculix"); }

TEST_CASE("umat_ serves Kratos: null pointers, small strains, points without a name") { expect_served("kratos"); }

TEST_CASE("umat_ serves MOOSE: spheres, line searches, tangents in calls of their own, true rates") {
  expect_served("moose", true);
}

TEST_CASE(
    "vumat_ gives the stress bits of the C interface, in parts where a step is too large, elastic before the first; in "
    "both precisions") {
  unsetenv("RVELAB_UMAT");
  for (const std::string name :
       {"discs", "discs_single", "spheres", "spheres_single", "shear", "round_off", "elastic", "parts", "refused"}) {
    CAPTURE(name);
    const Workplace here;
    prepare(here, name.starts_with("spheres"));
    const Outcome outcome = here.run(name + " .", RVELAB_VUMAT_HOST);
    CHECK(outcome.errors.empty());
    CHECK(outcome.code == 0);
  }
}

TEST_CASE("umat_ serves Kratos in space: its order of shear, no stress at first") {
  expect_served("kratos_in_space", true);
}

TEST_CASE("umat_ serves MOOSE, which turns stresses: told by PROPS(2), or seen and refused") {
  expect_served("moose_turns", true);
}

TEST_CASE("a host that goes on without a refused increment gets NaN and the reason; one that obeys gets its step") {
  expect_served("disobeys");
  expect_served("obeys");
}

TEST_CASE("a state that is copied to another point or process is refused once it has gone on elsewhere") {
  expect_served("moves");
}

TEST_CASE("first increments of points without names take no memory that stays") { expect_served("unnamed"); }

TEST_CASE("umat_ keeps its files where it began, its arithmetic from the host's, and tells what it cannot log") {
  unsetenv("RVELAB_UMAT");
  const Workplace here;
  prepare(here, true);
  const Outcome outcome = here.run("environment .", hosts);
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.errors,
             Contains("rvelab_umat.log cannot be written; it would say: element 0, point 0: STRESS of"));
}

TEST_CASE("umat_ answers what it cannot do with NaN and one text in its log") { expect_served("refused", true); }

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their runtimes allocate themselves
TEST_CASE("umat_ without memory at any request answers with NaN, and the call made again gives the step") {
  unsetenv("RVELAB_UMAT");
  const Workplace here;
  prepare(here, false);
  here.succeeds("LD_PRELOAD=" RVELAB_MEMORY_SHIM " " + hosts + " without_memory .", "env");
}
#endif

TEST_CASE("a mistake in the file of materials is told with line, key, value and remedy") {
  unsetenv("RVELAB_UMAT");
  const Workplace here;
  prepare(here, false);
  const std::string material = "[[material]]\nnumber = 1\nspecimen = \"discs.h5\"\n";
  const std::pair<std::string, std::string> mistakes[] = {
      {"[pool]\nworkers = 2\n" + material, "line 2: pool.workers is no key; allowed: trial_memory, "},
      {"[pool]\ntolerance_rel = \"low\"\n" + material, "line 2: pool.tolerance_rel is no number"},
      {"[pool]\nmax_substeps = 0\n" + material, "pool.max_substeps is 0; allowed: 1 to"},
      {"[pool]\ndamping = 2.5\n" + material, "damping"},
      {"[pool]\ntrial_memory = \"none\"\n" + material, "is \"none\"; allowed: \"keep\" (the default) or \"recompute\""},
      {"pool = 1\n" + material, "file.pool is no table"},
      {"[[material]]\nnumber = 1\n", "line 1: material.specimen is missing"},
      {"[[material]]\nspecimen = \"discs.h5\"\n", "material.number is missing"},
      {material + "tangent = \"jaumann\"\n", "line 4: material.tangent is \"jaumann\"; allowed: \"cauchy\""},
      {material + "shear_order = \"12 13 13\"\n", "line 4: material.shear_order is \"12 13 13\"; allowed: \"abaqus\""},
      {material + "initial_stress = \"zero\"\n", "material.initial_stress is \"zero\"; allowed: \"host\""},
      {material + material, "line 5: material.number is 1 a second time"},
      {"material = 3\n", "file.material is missing or no list of tables"},
      {"[[material]\n", "rvelab_umat.toml, line 1"},
  };
  for (const auto& [text, told] : mistakes) {
    here.write("rvelab_umat.toml", text);
    const Outcome outcome = here.run("told .", hosts);
    INFO(text);
    CHECK(outcome.output.starts_with("refused\nelement 0, point 0: "));
    CHECK_THAT(outcome.output, Contains(told));
  }
  // Of what is echoed the log has 80 letters at most, all of them printable.
  const std::string letters(200, 'k');
  for (const std::string& text :
       {"[pool]\n" + letters + " = 2\n" + material, "[pool]\n\"" + letters + " b\" = 2\n" + material,
        material + "tangent = \"\\u001b " + letters + " " + letters + "\"\n",
        "[[material]]\nnumber = 1\nspecimen = \"" + letters + ".h5\"\n"}) {
    here.write("rvelab_umat.toml", text);
    const Outcome outcome = here.run("told .", hosts);
    INFO(text);
    CHECK(outcome.output.starts_with("refused\nelement 0, point 0: "));
    CHECK_THAT(outcome.output, !Contains(std::string(80, 'k')) && !Contains("\x1b"));
  }
  std::filesystem::remove(here / "rvelab_umat.toml");
  CHECK_THAT(here.run("told .", hosts).output, Contains("let RVELAB_UMAT name the file"));

  // Elsewhere, with paths from where it is.
  std::filesystem::create_directory(here / "materials");
  here.write("materials/sand.toml", "[[material]]\nnumber = 1\nspecimen = \"../discs.h5\"\n");
  setenv("RVELAB_UMAT", "materials/sand.toml", 1);
  CHECK(here.run("told .", hosts).output == "done\n");
  unsetenv("RVELAB_UMAT");
}
