// rvelab import as a user meets it: which timestep, which dimension. What the files hold is tested in tests/io.
#include "tests/io/four_spheres.hpp"
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("import reads the timestep and the dimension that are asked for, and tells what it chose") {
  const Workplace here;
  FourSpheres layer;
  layer.cell(0, 2) = layer.cell(1, 2) = 0;
  for (PlacedSphere& grain : layer.grains) {
    grain.at[2] = 0;
    grain.radius /= 2;  // no deep overlaps in the plane
  }
  write_bytes(here / "m.toml", sand);
  write_bytes(here / "a.dump", frame_of({}, 5) + frame_of(layer, 10));
  const Outcome last = here.run("import a.dump --material m.toml -o S.h5");
  CHECK(last.code == 0);
  CHECK_THAT(last.errors, Contains("2 timesteps, 5 to 10") && Contains("taken as discs (2D); --dimension 3"));
  CHECK_THAT(here.run("inspect S.h5 --json").output, Contains("\"dimension\": 2"));
  CHECK(here.run("import a.dump --material m.toml --timestep 10 --dimension 3 -o S.h5 --force").code == 0);
  CHECK_THAT(here.run("inspect S.h5 --json").output, Contains("\"dimension\": 3"));
  const Outcome first = here.run("import a.dump --material m.toml --timestep 5 -o S.h5 --force");
  CHECK(first.code == 0);
  CHECK(first.errors.empty());
  here.refuses("import a.dump --material m.toml --timestep 7 -o S.h5 --force",
               "a.dump: has no timestep 7; allowed: 5, 10");
  here.refuses("import a.dump --material m.toml --dimension 4 -o S.h5 --force", "--dimension");
  const std::string whole = frame_of({}, 5) + frame_of(layer, 10);
  write_bytes(here / "cut.dump", whole.substr(0, whole.size() - 3));
  here.refuses("import cut.dump --material m.toml -o T.h5", "--timestep 5 reads it");
}
