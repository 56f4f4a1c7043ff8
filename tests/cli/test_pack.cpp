// rvelab pack as a user runs it.

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tests/child.hpp"
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

const char* const small = R"([pack]
name = "small"
number = 60
[grains]
smallest_radius_m = 3e-3
largest_radius_m = 7e-3
[target]
pressure_Pa = 1e5
void_ratio = 0.2
void_ratio_tolerance = 2e-3
[[material]]
young_modulus_Pa = 8e8
stiffness_ratio = 0.5
friction = 0.4
)";

}  // namespace

TEST_CASE("pack writes a specimen that remembers its seed and its recipe, the same on any number of threads") {
  const Workplace here;
  here.write("small.toml", small);
  const auto made = here.json("pack small.toml -o S.h5 --set pack.seed=5 --threads 1");
  CHECK(made["seed"] == 5);
  CHECK(made["void_ratio"].get<double>() == Approx(0.2).margin(2e-3));
  CHECK(made["stress_Pa"][0][0].get<double>() == Approx(-1e5).epsilon(1e-3));
  CHECK(made["unbalanced_force_ratio"].get<double>() < 1e-5);

  const auto origin = rvelab::io::read_origin(here / "S.h5");
  REQUIRE(origin);
  CHECK(origin->seed == 5);
  CHECK(origin->draw == made["draw"].get<std::int64_t>());
  CHECK(origin->preparation_friction == made["preparation_friction"].get<double>());

  // The recipe in the file makes the file again.
  here.write("again.toml", origin->recipe);
  here.succeeds("pack again.toml -o A.h5 --threads 3");
  const Outcome same = here.run("compare S.h5 A.h5");
  INFO(same.output);
  CHECK(same.code == 0);
  CHECK(here.json("inspect S.h5")["seed"] == 5);
}

TEST_CASE("pack makes families over pressures and seeds, each in a file of its own") {
  const Workplace here;
  std::string text = small;
  text.replace(text.find("pressure_Pa = 1e5"), 17, "pressures_Pa = [5e4, 1e5]");
  text.replace(text.find("void_ratio = 0.2\nvoid_ratio_tolerance = 2e-3\n"), 45, "");
  here.write("family.toml", text);
  const auto made = here.json("pack family.toml -o F.h5 --count 2 --threads 2")["specimens"];
  REQUIRE(made.size() == 4);
  std::size_t k = 0;
  for (const double pressure : {5e4, 1e5}) {
    for (const int number : {1, 2}) {
      const std::string file =
          "F_" + std::string(pressure == 5e4 ? "50000" : "100000") + "Pa_" + std::to_string(number) + ".h5";
      CHECK(made[k]["file"] == file);
      CHECK(made[k]["seed"] == number);
      CHECK(made[k]["stress_Pa"][1][1].get<double>() == Approx(-pressure).epsilon(1e-3));
      CHECK(std::filesystem::exists(here / file));
      ++k;
    }
  }
}

TEST_CASE("pack says what is wrong before it works, and what was reached after it") {
  const Workplace here;
  here.write("small.toml", small);
  here.refuses("pack small.toml", "-o");
  here.refuses("pack small.toml -o none/S.h5", "the folder none does not exist");
  here.refuses("pack smal.toml -o S.h5", "smal.toml: no such file");
  here.refuses("pack pack_dens -o S.h5", "no recipe \"pack_dens\" is installed; the nearest is pack_dense");
  here.refuses("pack biaxial -o S.h5", "is no recipe, it has no [pack]");
  here.refuses("run pack_dense --specimen S.h5", "is a recipe and no test");
  here.refuses("pack small.toml -o S.h5 --set target.void_rato=0.2", "nearest", "target.void_ratio");
  const Outcome outcome =
      here.run("pack small.toml -o S.h5 --set target.void_ratio=0.05 --set preparation.max_draws=4");
  CHECK(outcome.code == 1);
  CHECK_THAT(outcome.errors,
             Contains("0.002") && Contains("4 packings") && Contains("reached: 0.") && !Contains("lowest_friction"));
  CHECK(!std::filesystem::exists(here / "S.h5"));
}

TEST_CASE("a packing stops soon after the signal, while it draws and scatters a million grains too") {
  const Workplace here;
  std::string text = small;
  const auto grains = text.find("smallest_radius_m"), end = text.find("[target]");
  text.replace(grains, end - grains, "passing_by = \"mass\"\nsmallest_radius_m = 1e-6\nlargest_radius_m = 1e-3\n");
  text.replace(text.find("number = "), text.find('\n', text.find("number = ")) - text.find("number = "),
               "number = 1000000\nshape = \"sphere\"");
  here.write("wide.toml", text);
  for (const double after : {0.3, 1.5, 4.0}) {  // of processor time: other work on the machine is not in it
    CAPTURE(after);
    Child packing({RVELAB_PROGRAM, "pack", here / "wide.toml", "-o", here / "W.h5"}, here / "out", here / "err");
    CHECK(packing.works_for(after));
    const double before = packing.processor_seconds();
    packing.signal(SIGTERM);
    CHECK(packing.wait_for(120) == 143);
    CHECK(packing.processor_seconds() - before < 5);  // of all its threads
    CHECK_THAT(bytes_of(here / "err"), Contains("warning: ") && Contains("pack.number = 1000000") &&
                                           Contains("SIGTERM") && Contains("0 of 1 specimens"));
    CHECK(!std::filesystem::exists(here / "W.h5"));
  }
}

TEST_CASE("protocols lists recipes apart from tests") {
  const Workplace here;
  const std::string text = here.run("protocols").output;
  const auto recipes = text.find("\nRecipes, for rvelab pack:\n");
  REQUIRE(recipes != std::string::npos);
  CHECK(text.find("biaxial") < recipes);
  CHECK(text.find("pack_dense") > recipes);
  CHECK(here.run("protocols pack_dense").output == bytes_of(RVELAB_SOURCE_DIR "/protocols/pack_dense.toml"));
}

TEST_CASE("the shipped recipe of Hertz spheres can be probed by the shipped protocol", "[slow]") {
  const Workplace here;
  // In this draw a grain touches down late in a probe.
  here.succeeds("pack pack_hertz -o S.h5 --set pack.number=300");
  const std::string probed = here.succeeds("run probe --specimen S.h5");
  CHECK_THAT(probed, Contains("stiffness_Pa"));
}
