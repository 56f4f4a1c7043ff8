// Wrong units, soft grains and lists beyond all bounds, as a user meets them: told in one line, soon, and with a
// remedy.
#include <sys/resource.h>

#include <cmath>
#include <sstream>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/program.hpp"

using namespace rvelab::test;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

const char* const few_grains = R"([pack]
name = "small"
number = 60
[grains]
smallest_radius_m = 3e-3
largest_radius_m = 7e-3
[target]
pressure_Pa = 1e5
[preparation]
friction = 0.1
[[material]]
name = "sand"
young_modulus_Pa = 8e8
stiffness_ratio = 0.5
friction_angle_deg = 23
)";

/// Processor time of all programs that were run and have ended, s.
double seconds_of_children() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Particles of a file with radii `factor` times as large.
std::string with_radii_times(const std::string& path, double factor) {
  std::ifstream input(path);
  std::string line, text;
  std::size_t column = 0;
  for (bool header = false; std::getline(input, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (!header) {
      while (cells[column] != "r" && cells[column] != "radius") ++column;
      header = true;
    } else {
      std::ostringstream radius;
      radius.precision(17);
      radius << factor * std::stod(cells[column]);
      cells[column] = radius.str();
    }
    for (std::size_t k = 0; k < cells.size(); ++k) text += (k > 0 ? "," : "") + cells[k];
    text += "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("radii in mm or cm for m are refused by import with the unit in doubt, and nothing is written") {
  const Workplace here;
  const std::string stem = std::string(RVELAB_TEST_DATA) + "/yade/dense";
  for (const double factor : {10.0, 1000.0, 1e8, 1e200}) {
    CAPTURE(factor);
    here.write("p.csv", with_radii_times(stem + ".particles.csv", factor));
    here.refuses("import p.csv " + stem + ".json -o S.h5", "in mm?");
    CHECK(!std::filesystem::exists(here / "S.h5"));
  }
}

TEST_CASE("all of import, pack and inspect say what the numbers of a specimen are to each other") {
  const Workplace here;
  here.write("small.toml", few_grains);
  const std::string packed = here.succeeds("pack small.toml -o P.h5");
  here.import_packing("hertz");
  for (const std::string file : {"P.h5", "S.h5"}) {
    CAPTURE(file);
    const Outcome shown = here.run("inspect " + file);
    CHECK_THAT(shown.output, Contains("proportions") && Contains("mean diameter ") && Contains("void ratio ") &&
                                 Contains("overlap ") && Contains(" r (largest ") && Contains("kn/(p ") &&
                                 Contains(" diameters\n"));
    const Json json = Json::parse(here.run("inspect " + file + " --json").output);
    const rvelab::Network network = rvelab::Rve(rvelab::io::read_specimen(here / file)).network();
    const int d = network.dimension();
    CHECK(json["mean_diameter_m"].get<double>() == rvelab::mean_diameter(network));
    CHECK(json["largest_overlap_ratio"].get<double>() == rvelab::largest_overlap_ratio(network));
    double overlap = 0, stiffness = 0;
    for (const auto& c : network.contacts) {
      overlap += c.overlap / std::min(network.grains[std::size_t(c.i)].radius, network.grains[std::size_t(c.j)].radius);
      stiffness += c.normal_stiffness;
    }
    const double contacts = double(network.contacts.size()), diameter = rvelab::mean_diameter(network);
    CHECK(json["mean_overlap_ratio"].get<double>() == Approx(overlap / contacts));
    const double pressure = rvelab::mean_pressure(rvelab::contact_stress(network), d);
    const double width = d == 2 ? network.cell.lattice(2, 2) : diameter;
    CHECK(json["stiffness_level"].get<double>() == Approx(stiffness / contacts / (pressure * width)));
    REQUIRE(json["cell_edges_in_diameters"].size() == std::size_t(d));
    CHECK(json["cell_edges_in_diameters"][0].get<double>() == Approx(network.cell.lattice.col(0).norm() / diameter));
    CHECK(json["void_ratio"].get<double>() == Approx(rvelab::void_ratio(network)));
    CHECK(json.count("proportions") == 0);
    // The grading by mass, and the largest grain.
    double mass = 0, largest = 0, of_largest = 0;
    for (const auto& grain : network.grains) {
      mass += grain.mass;
      largest = std::max(largest, 2 * grain.radius);
      of_largest = std::max(of_largest, grain.mass);
    }
    for (const auto& [key, part] : {std::pair("d10_m", 0.1), {"d50_m", 0.5}, {"d90_m", 0.9}}) {
      CAPTURE(key);
      double below = 0, with = 0;
      for (const auto& grain : network.grains) {
        if (2 * grain.radius < json[key].get<double>()) below += grain.mass;
        if (2 * grain.radius <= json[key].get<double>()) with += grain.mass;
      }
      CHECK(below <= part * mass * (1 + 1e-12));
      CHECK(with >= part * mass * (1 - 1e-12));
    }
    CHECK(json["largest_grain_mass_share"].get<double>() == Approx(of_largest / mass));
    CHECK(json["cell_over_largest_diameter"].get<double>() ==
          Approx(rvelab::heights(network.cell).head(d).minCoeff() / largest));
  }
  // The same line from pack and from import.
  const std::string shown = here.run("inspect P.h5").output;
  const auto line = shown.substr(shown.find("void ratio "), shown.find(" diameters\n") - shown.find("void ratio "));
  CHECK_THAT(packed, Contains(line));
  const std::string stem = std::string(RVELAB_TEST_DATA) + "/yade/hertz";
  const std::string import = "import " + stem + ".particles.csv " + stem + ".contacts.csv " + stem + ".json -o I.h5";
  CHECK_THAT(here.run(import).output, Contains("proportions") && Contains("kn/(p d) "));
  CHECK(Json::parse(here.run(import + " --force --json").output)["stiffness_level"].get<double>() > 10);
}

TEST_CASE(
    "pack and inspect print the diameters that a recipe asks for, those of its grains, and what scalping cuts off") {
  const Workplace here;
  here.write("small.toml", few_grains);
  const Json made =
      here.json("pack small.toml -o P.h5 --set grains.sampling=stratified --set grains.scalp_above_mm=12");
  const Json shown = here.json("inspect P.h5");
  // By number every radius from 3 to 6 mm is equally frequent: the mass of discs below r goes with r^3 - 27 mm^3.
  for (const auto& [key, part] : {std::pair("d10_m", 0.1), {"d50_m", 0.5}, {"d90_m", 0.9}}) {
    CAPTURE(key);
    const double asked = 2e-3 * std::cbrt(27 + part * (216 - 27));
    for (const Json& json : {made, shown}) {
      CHECK(json["asked_" + std::string(key)].get<double>() == Approx(asked).epsilon(1e-9));
      CHECK(json[key].get<double>() == Approx(asked).epsilon(0.03));
      CHECK(json["scalped_above_percent"].get<double>() == Approx(100.0 * (343 - 216) / (343 - 27)).epsilon(1e-9));
      CHECK(json.count("scalped_below_percent") == 0);
    }
    CHECK(made[key] == shown[key]);
  }
  CHECK_THAT(here.run("inspect P.h5").output, Contains("asked_d50_m") && Contains("scalped_above_percent       40.19"));
  // An imported specimen was asked for nothing.
  here.import_packing("hertz");
  CHECK(here.json("inspect S.h5").count("asked_d50_m") == 0);
}

TEST_CASE("a grain that is too large for its specimen is reported by pack, inspect and run, once each") {
  const Workplace here;
  here.write("few.toml", few_grains);
  const Outcome packed = here.run("pack few.toml -o F.h5 --set pack.number=12");
  CHECK(packed.code == 0);
  CHECK_THAT(packed.errors, Contains("pack.number = 12 is few") && Contains("usual: up to 5 %, which takes "));
  for (const char* command : {"inspect F.h5", "run biaxial --specimen F.h5 --set stage.compression.to_strain=0.001"}) {
    CAPTURE(command);
    const Outcome shown = here.run(command);
    INFO(shown.errors);
    const auto at = shown.errors.find("warning: F.h5: the largest grain has ");
    REQUIRE(at != std::string::npos);
    CHECK(shown.errors.find("the largest grain has ", at + 40) == std::string::npos);
    // As many grains of these sizes as make that one 5 %.
    const double share = std::stod(shown.errors.substr(at + 37));
    const auto takes = shown.errors.find("which takes ");
    REQUIRE(takes != std::string::npos);
    CHECK(std::stod(shown.errors.substr(takes + 12)) == Approx(12 * share / 5).margin(1.01));
  }
  here.succeeds("pack few.toml -o M.h5");
  CHECK_THAT(here.run("inspect M.h5").errors, !Contains("largest grain"));
  here.write("grains.csv", "x, y, radius\n0.005, 0.005, 0.00401\n0.015, 0.005, 0.002\n0.005, 0.015, 0.002\n");
  here.write("material.toml",
             "[[material]]\nname = \"sand\"\nyoung_modulus_Pa = 8e8\nstiffness_ratio = 0.5\nfriction = 0.4\n");
  here.succeeds("import grains.csv --cell 0.02,0.02,0.01 --material material.toml -o I.h5");
  // Discs of radii 4.01, 2 and 2 mm in a cell of 20 mm.
  CHECK_THAT(here.run("inspect I.h5").errors,
             Contains("warning: I.h5: the largest grain has 66.8 % of the mass") &&
                 Contains("the cell is about 2.49 largest diameters wide; usual: 3 or more, which takes 5 grains"));
}

TEST_CASE("pack takes no overlaps beyond the limit, and tells discs in a thick slab why") {
  const Workplace here;
  std::string text = few_grains;
  text.replace(text.find("3e-3"), 4, "1e-3");
  text.replace(text.find("7e-3"), 4, "2e-3");
  text.replace(text.find("8e8"), 3, "2e7");
  here.write("mm.toml", text);
  const auto work_of = [&](const std::string& command, Outcome& outcome) {
    const double before = seconds_of_children();
    outcome = here.run(command);
    return seconds_of_children() - before;
  };
  Outcome thick, search;
  const double one_draw = work_of("pack mm.toml -o S.h5", thick);
  INFO(thick.errors);
  CHECK(thick.code == 1);
  CHECK(std::count(thick.errors.begin(), thick.errors.end(), '\n') == 2);  // with what is unusual, before the work
  CHECK_THAT(thick.errors, Contains("solver.max_overlap_ratio allows 0.25") &&
                               Contains("pack.thickness_m = 0.1 m is") && Contains("stiffer grains"));
  CHECK(!std::filesystem::exists(here / "S.h5"));
  // A search does not go on for a hundred packings.
  here.write("search.toml", text.substr(0, text.find("[preparation]")) + "void_ratio = 0.2\n" +
                                text.substr(text.find("[[material]]")));
  CHECK(work_of("pack search.toml -o S.h5 --threads 1", search) < 20 * one_draw);
  CHECK_THAT(search.errors, Contains("pack.thickness_m = 0.1 m is"));
  // As thick as a grain they are stiff enough.
  const std::string thin = here.succeeds("pack mm.toml -o S.h5 --set pack.thickness_m=3e-3 --json");
  CHECK(Json::parse(thin)["largest_overlap_ratio"].get<double>() < 0.25);
}

TEST_CASE("a cell too small for its grains is no packing") {
  const Workplace here;
  std::string text = few_grains;
  text.replace(text.find("pressure_Pa = 1e5"), 17, "void_ratio = -0.4");
  here.write("full.toml", text);
  const Outcome outcome = here.run("pack full.toml -o S.h5");
  INFO(outcome.errors);
  CHECK(outcome.code == 1);
  CHECK_THAT(outcome.errors, Contains("max_overlap_ratio allows 0.25") && Contains("raise target.void_ratio"));
  CHECK(!std::filesystem::exists(here / "S.h5"));
}

TEST_CASE("a skin beyond all use is refused by its key before anything is packed or run") {
  const Workplace here;
  here.write("small.toml", few_grains);
  for (const char* skin : {"100", "1000", "1e10", "2147483648", "4294967296"}) {
    CAPTURE(skin);
    here.refuses("pack small.toml -o S.h5 --set solver.skin=" + std::string(skin),
                 "is out of range; allowed: above 0 to 10");
  }
}

TEST_CASE("pack takes material.key for all materials, and material.NAME.key for one, as keys says") {
  const Workplace here;
  const std::string text = few_grains + std::string("[[material]]\nname = \"glass\"\nyoung_modulus_Pa = 8e8\n") +
                           "stiffness_ratio = 0.5\nfriction = 0.4\n";
  here.write("two.toml", text);
  const auto frictions = [&](const std::string& settings) {
    here.succeeds("pack two.toml -o S.h5 --force --set pack.number=30 " + settings);
    const rvelab::Specimen s = rvelab::io::read_specimen(here / "S.h5");
    return std::pair(s.materials.at(0).friction, s.materials.at(1).friction);
  };
  CHECK(frictions("--set material.friction=0.3") == std::pair(0.3, 0.3));
  const auto one = frictions("--set material.glass.friction=0.2");
  CHECK(one.first == Approx(std::tan(23 * 3.14159265358979 / 180)));
  CHECK(one.second == 0.2);
  CHECK(frictions("--set material.sand.friction=0.1") == std::pair(0.1, 0.4));
  const auto angle = frictions("--set material.friction_angle_deg=45");
  CHECK(angle.first == Approx(1));
  CHECK(angle.second == Approx(1));
  here.refuses("pack two.toml -o S.h5 --force --set material.frictoin=0.3", "the nearest known key is");
  here.refuses("pack two.toml -o S.h5 --force --set material.friction=-1",
               "--set material.friction=-1: material.friction = -1 is out of range");
  here.refuses("pack two.toml -o S.h5 --force --set material.clay.friction=0.3", "0 (sand), 1 (glass)");
}

TEST_CASE("a void ratio far out of reach is refused after a few rounds of packings, with the range that was reached") {
  const Workplace here;
  std::string text = few_grains;
  text.replace(text.find("[preparation]\nfriction = 0.1\n"), 29, "");
  here.write("search.toml", text);
  for (const char* target : {"0.05", "0.6"}) {
    CAPTURE(target);
    const Outcome outcome = here.run("pack search.toml -o S.h5 --set target.void_ratio=" + std::string(target));
    CHECK(outcome.code == 1);
    INFO(outcome.errors);
    const auto at = outcome.errors.find(" packings");
    REQUIRE(at != std::string::npos);
    CHECK(std::stoi(outcome.errors.substr(outcome.errors.rfind(' ', at - 1))) <= 16);  // of 100
    CHECK_THAT(outcome.errors, Contains("; reached: 0.") && Contains("too far from it for more packings") &&
                                   Contains(target[2] == '0' ? "give a higher void ratio" : "give a lower void ratio"));
  }
}

TEST_CASE("a specimen without friction exports every contact that inspect counts") {
  const Workplace here;
  here.write("small.toml", few_grains);
  here.succeeds("pack small.toml -o S.h5 --set material.friction=0");
  const long contacts = Json::parse(here.run("inspect S.h5 --json").output)["contacts"];
  REQUIRE(contacts > 60);
  const std::string exported = here.succeeds("export S.h5 --format csv -o out --json");
  const std::string table = bytes_of(here / "out.contacts.csv");
  CHECK(std::count(table.begin(), table.end(), '\n') == contacts + 2);
  CHECK(Json::parse(bytes_of(here / "out.json"))["n_contacts"] == contacts);
  // They come back with the forces of the law, and the stress is the same.
  const std::string import = Json::parse(exported)["import_with"];
  const double p = Json::parse(here.run("inspect S.h5 --json").output)["p_Pa"];
  here.succeeds(import.substr(7) + " --force");
  CHECK(Json::parse(here.run("inspect S.h5 --json").output)["p_Pa"].get<double>() == Approx(p).epsilon(1e-9));
}
