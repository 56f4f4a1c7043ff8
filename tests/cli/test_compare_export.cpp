// rvelab compare and rvelab export as a user meets them. What the files hold is tested in tests/io.
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("compare says equal, or the first difference with exit code 1, which is no mistake") {
  const Workplace here;
  here.import_packing("dense_p20", "a.h5");
  here.import_packing("dense_p20", "b.h5");
  here.import_packing("dense_p10", "c.h5");
  const Outcome equal = here.run("compare a.h5 b.h5");
  CHECK(equal.code == 0);
  CHECK(equal.errors.empty());
  CHECK_THAT(equal.output, Contains("equal: ") && Contains(" datasets\n"));
  const Outcome other = here.run("compare a.h5 c.h5");
  CHECK(other.code == 1);
  CHECK(other.errors.empty());
  CHECK(std::count(other.output.begin(), other.output.end(), '\n') == 1);
  CHECK_THAT(other.output,
             Contains("/cell/lattice_m[0, 0] differs: ") && Contains(" in a.h5, ") && Contains(" in c.h5"));
  const auto json = nlohmann::json::parse(here.run("compare a.h5 c.h5 --json").output);
  CHECK(json["equal"] == false);
  CHECK(json["difference"].get<std::string>() + "\n" == other.output);
  CHECK(here.json("compare a.h5 b.h5")["difference"].is_null());
  here.refuses("compare a.h5 none.h5", "none.h5: no such file");
}

TEST_CASE("a specimen exported as CSV and imported again as the export says is the same file") {
  const Workplace here;
  for (const char* name : {"dense", "hertz", "noroll"}) {
    CAPTURE(name);
    here.import_packing(name);
    const auto json = here.json("export S.h5 --format csv -o out --force");
    CHECK(json["written"].size() == 4);
    const std::string command = json["import_with"];
    REQUIRE(command.starts_with("rvelab import "));
    std::filesystem::rename(here / "S.h5", here / "first.h5");  // the name that the command writes to
    here.succeeds(command.substr(7));
    const Outcome compared = here.run("compare first.h5 S.h5");
    CHECK_THAT(compared.output, Contains("equal: "));
    // One material and a law that META.json can say: the parameters need no file of their own.
    here.succeeds("import out.particles.csv out.contacts.csv out.json -o meta.h5 --force");
    CHECK_THAT(here.run("compare first.h5 meta.h5").output, Contains("equal: "));
    std::filesystem::remove(here / "S.h5");
  }
}

TEST_CASE("a cemented test says how many bonds there are, shows them in ParaView, and which files leave them out") {
  const Workplace here;
  here.succeeds("pack pack_dense -o S.h5 --set pack.number=60");
  here.succeeds("run biaxial_cemented --specimen S.h5 -o C.h5 --set stage.compression.to_strain=0.002");
  const auto seen = here.json("inspect C.h5");
  CHECK(seen["bonds"] > 60);
  // Bonds that break at a touch are none: they are counted apart.
  const std::string weak = "tensile_strength_Pa=1e-6 --set stage.cement.cohesion_Pa=1e-6";
  here.succeeds(
      "run biaxial_cemented --specimen S.h5 -o W.h5 --set stage.compression.to_strain=0.002 --set "
      "stage.cement." +
      weak);
  const auto broken = here.json("inspect W.h5");
  CHECK(broken["bonds"] < 10);
  CHECK(broken["bonds"].get<long>() + broken["bonds_broken"].get<long>() ==
        seen["bonds"].get<long>() + seen["bonds_broken"].get<long>());
  const auto exported = [&](const std::string& format) {
    return here.json("export C.h5 --format " + format + " -o " + format);
  };
  for (const char* format : {"csv", "lammps", "lammps-data"})
    CHECK(exported(format)["left_out"] == "bonds: only xdmf and specimen files hold them");
  CHECK(!exported("xdmf").contains("left_out"));
  const std::string text = bytes_of(here / "xdmf");
  CHECK(text.find("Grid Name=\"bonds\"") != std::string::npos);
  CHECK(text.find("bonds/broken") != std::string::npos);
}

TEST_CASE("an export never replaces the file that it is made from, and needs a folder") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string before = bytes_of(here / "S.h5");
  here.refuses("export S.h5 --format lammps -o S.h5", "would replace S.h5");
  std::filesystem::rename(here / "S.h5", here / "S.xdmf.h5");
  here.refuses("export S.xdmf.h5 --format xdmf -o S.xdmf", "would replace S.xdmf.h5");
  CHECK(bytes_of(here / "S.xdmf.h5") == before);
  here.refuses("export S.xdmf.h5 --format lammps -o no/S.dump", "the folder no does not exist");
  here.refuses("export S.xdmf.h5 --format vtk -o S.vtk", "vtk not in");
  const auto data = here.json("export S.xdmf.h5 --format lammps-data -o S.data");
  CHECK(data["written"] == nlohmann::json::array({"S.data"}));
  const auto xdmf = here.json("export S.xdmf.h5 --format xdmf -o T.xdmf");
  CHECK(xdmf["written"] == nlohmann::json::array({"T.xdmf", "T.xdmf.h5"}));
  CHECK(xdmf["states"] == 1);
  CHECK_THAT(bytes_of(here / "S.data"), Contains("400 atoms\n1 atom types\n"));
}

TEST_CASE("a dump goes out and comes back through the program with the same cell and grains") {
  const Workplace here;
  here.import_packing("hertz");
  here.succeeds("export S.h5 --format csv -o s");  // for its material file
  here.succeeds("export S.h5 --format lammps -o s.dump");
  here.succeeds("import s.dump --material s.material.toml -o T.h5");
  const auto before = here.json("inspect S.h5");
  const auto after = here.json("inspect T.h5");
  for (const char* key : {"dimension", "grains", "contacts", "lattice_m", "coordination_number"}) {
    CAPTURE(key);
    CHECK(after[key] == before[key]);
  }
  CHECK(after["void_ratio"].get<double>() == Approx(before["void_ratio"].get<double>()).epsilon(1e-14));
  here.refuses("import s.dump --material s.material.toml --cell 1,1,1 -o U.h5", "s.dump has a cell too");
  here.refuses("import s.dump -o U.h5", "comes without contact parameters");
}
