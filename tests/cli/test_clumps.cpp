// Clumps as a user meets them: packed, tested, shown, and refused where files cannot hold them.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("clumps are packed, compressed, gone on with and exported with the body of each member") {
  const Workplace here;
  const Outcome packed = here.run("pack pack_clumps -o S.h5 --set pack.number=40 --set target.unbalanced=1e-4 --json");
  INFO(packed.errors);
  REQUIRE(packed.code == 0);
  const auto told = nlohmann::json::parse(here.run("inspect S.h5 --json").output);
  INFO(told.dump());
  CHECK(told.dump().find("members") != std::string::npos);
  const Outcome ran = here.run("run triaxial --specimen S.h5 -o R.h5 --set stage.compression.to_strain=0.001");
  INFO(ran.errors);
  CHECK(ran.code == 0);
  REQUIRE(here.run("export S.h5 --format xdmf -o S.xdmf").code == 0);
  CHECK_THAT(bytes_of(here / "S.xdmf"), Contains("Name=\"body\""));
  REQUIRE(here.run("export S.h5 --format csv -o out").code == 0);
  CHECK_THAT(bytes_of(here / "out.particles.csv"), Contains(",material,body\n"));
  expect_mistake(here.run("export S.h5 --format lammps-data -o S.data"), "clumps");
  expect_mistake(here.run("import out.particles.csv out.contacts.csv out.json -o again.h5"), "clumps");
}
