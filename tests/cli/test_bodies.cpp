// Clumps and ellipsoids as a user meets them: packed, tested, shown, and refused where files cannot hold them.
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// `told`: of `rvelab inspect`; `header`: the last columns of a table of particles; `refused`: in what formats say that
/// cannot hold them.
void check_files(const Workplace& here, const std::string& recipe, const char* told, const char* header,
                 const char* refused) {
  const Outcome packed =
      here.run("pack " + recipe + " -o S.h5 --set pack.number=40 --set target.unbalanced=1e-4 --json");
  INFO(packed.errors);
  REQUIRE(packed.code == 0);
  const auto inspected = nlohmann::json::parse(here.run("inspect S.h5 --json").output);
  INFO(inspected.dump());
  CHECK(inspected.dump().find(told) != std::string::npos);
  const Outcome ran = here.run("run triaxial --specimen S.h5 -o R.h5 --set stage.compression.to_strain=0.001");
  INFO(ran.errors);
  CHECK(ran.code == 0);
  REQUIRE(here.run("export S.h5 --format xdmf -o S.xdmf").code == 0);
  REQUIRE(here.run("export S.h5 --format csv -o out").code == 0);
  CHECK_THAT(bytes_of(here / "out.particles.csv"), Contains(header));
  expect_mistake(here.run("export S.h5 --format lammps-data -o S.data"), refused);
  expect_mistake(here.run("import out.particles.csv out.contacts.csv out.json -o again.h5"), refused);
}

}  // namespace

TEST_CASE("clumps are packed, compressed, gone on with and exported with the body of each member") {
  const Workplace here;
  check_files(here, "pack_clumps", "members", ",material,body\n", "clumps");
  CHECK_THAT(bytes_of(here / "S.xdmf"), Contains("Name=\"body\""));
}

TEST_CASE("ellipsoids are packed, compressed, gone on with and exported with axes that ParaView draws") {
  const Workplace here;
  check_files(here, "pack_ellipsoids", "sphericity",
              ",half_x,half_y,half_z,exponent_xy,exponent_z,q0,q1,q2,q3,material,body\n", "superellipsoids");
  CHECK_THAT(bytes_of(here / "S.xdmf"), Contains("Name=\"half_axes_m\"") && Contains("Name=\"quaternion\""));
}
