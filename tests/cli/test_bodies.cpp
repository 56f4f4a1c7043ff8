// Clumps and ellipsoids as a user meets them: packed, tested, shown, and refused where files cannot hold them.
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// `told`: of `rvelab inspect`; `header`: the last columns of a table of particles; `refused`: in what formats say that
/// cannot hold them.
void check_files(const Workplace& here, const std::string& recipe, const char* told, const char* header,
                 const char* refused) {
  here.succeeds("pack " + recipe + " -o S.h5 --set pack.number=40 --set target.unbalanced=1e-4 --json");
  const auto inspected = here.json("inspect S.h5");
  INFO(inspected.dump());
  CHECK(inspected.dump().find(told) != std::string::npos);
  here.succeeds("run triaxial --specimen S.h5 -o R.h5 --set stage.compression.to_strain=0.001");
  here.succeeds("export S.h5 --format xdmf -o S.xdmf");
  here.succeeds("export S.h5 --format csv -o out");
  CHECK_THAT(bytes_of(here / "out.particles.csv"), Contains(header));
  here.refuses("export S.h5 --format lammps-data -o S.data", refused);
  here.refuses("import out.particles.csv out.contacts.csv out.json -o again.h5", refused);
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
