// Ellipsoids as a user meets them: packed, tested, shown, and refused where files cannot hold them.
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("ellipsoids are packed, compressed, gone on with and exported with axes that ParaView draws") {
  const Workplace here;
  const Outcome packed =
      here.run("pack pack_ellipsoids -o S.h5 --set pack.number=40 --set target.unbalanced=1e-4 --json");
  INFO(packed.errors);
  REQUIRE(packed.code == 0);
  const auto told = nlohmann::json::parse(here.run("inspect S.h5 --json").output);
  INFO(told.dump());
  CHECK(told.dump().find("sphericity") != std::string::npos);
  const Outcome ran = here.run("run triaxial --specimen S.h5 -o R.h5 --set stage.compression.to_strain=0.001");
  INFO(ran.errors);
  CHECK(ran.code == 0);
  REQUIRE(here.run("export S.h5 --format xdmf -o S.xdmf").code == 0);
  CHECK_THAT(bytes_of(here / "S.xdmf"), Contains("Name=\"half_axes_m\"") && Contains("Name=\"quaternion\""));
  REQUIRE(here.run("export S.h5 --format csv -o out").code == 0);
  CHECK_THAT(bytes_of(here / "out.particles.csv"),
             Contains(",half_x,half_y,half_z,exponent_xy,exponent_z,q0,q1,q2,q3,material,body\n"));
  expect_mistake(here.run("export S.h5 --format lammps-data -o S.data"), "superellipsoids");
  expect_mistake(here.run("import out.particles.csv out.contacts.csv out.json -o again.h5"), "superellipsoids");
}
