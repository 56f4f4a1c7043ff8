// The program: words and exit codes that others rely on.
#include <cmath>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tests/io/record_files.hpp"
#include "tests/program.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

std::string files(const std::string& name) {
  const std::string stem = std::string(RVELAB_TEST_DATA) + "/yade/" + name;
  return stem + ".particles.csv " + stem + ".contacts.csv " + stem + ".json ";
}

}  // namespace

TEST_CASE("a mistake of an import is one line on standard error and exit code 2") {
  const Workplace here;
  here.refuses("import p.csv -o s.h5", "p.csv: no such file");
  here.refuses("import p.csv --cell 1,2 -o s.h5", "--cell");
  here.refuses("import m.json -o s.h5", "PARTICLES.csv");
  here.refuses("import " + files("dense") + "--set contact.slp=1 -o s.h5", "contact.slip");
  here.write("m.toml", "[contat]\n[solver]\nskn = 1\n");
  here.refuses("import " + files("dense") + "--material m.toml -o s.h5", "m.toml:1", "m.toml:3", "solver.skin");
  CHECK(!std::filesystem::exists(here / "s.h5"));
}

TEST_CASE("an imported packing, inspected, has the stress, void ratio and coordination number that were recorded") {
  const Workplace here;
  for (const std::string name : {"dense", "hertz"}) {
    CAPTURE(name);
    here.succeeds("import --set contact.slip=full_radius_ratcheting " + files(name) + "-o " + name + ".h5");
    const auto found = here.json("inspect " + name + ".h5");
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
    CHECK_THAT(here.succeeds("inspect " + name + ".h5"), Contains("stress_Pa") && Contains(" Pa\n"));
  }
}

TEST_CASE("a record file, inspected, tells its protocol and shows its end state") {
  const Workplace here;
  here.import_packing("dense");
  records::TestResult result;
  result.protocol = "biaxial";
  result.stages = {"shear"};
  result.records.resize(12);
  test::write_records(result, io::read_specimen(here / "S.h5"), "", here / "r.h5");
  const auto found = here.json("inspect r.h5");
  CHECK(found["kind"] == "records");
  CHECK(found["records"] == 12);
  CHECK(found["protocol"] == "biaxial");
  CHECK(found["grains"] == 400);
}
