// Keys of materials, contacts, damping and solver: what a user writes reaches its field, and what cannot be used is
// answered with the key, the value, the range and the line.
#include "rvelab/keys/material_toml.hpp"

#include <cmath>
#include <set>

#include "tests/catch.hpp"
#include "tests/io/random_specimen.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Specimen two_materials() {
  Specimen specimen;
  specimen.materials.resize(2);
  specimen.materials[0].name = "sand";
  specimen.materials[1].name = "gravel";
  return specimen;
}

std::string refused(const std::string& assignment) {
  Specimen specimen = two_materials();
  const Specimen before = specimen;
  const std::string message = input_error([&] { keys::set_key(specimen, assignment); });
  CHECK(differences(before, specimen) == 0);  // a refused key changes nothing
  return message;
}

std::string read_file(const std::string& text, Specimen& specimen) {
  const Folder folder;
  write_bytes(folder / "m.toml", text);
  return input_error([&] { keys::read_material_file(folder / "m.toml", specimen); });
}

}  // namespace

TEST_CASE("every key sets one field, from its own default, and no two keys the same but the documented pairs") {
  std::set<std::string> names;
  for (const keys::Key& key : keys::known_keys()) {
    CAPTURE(key.dotted());
    CHECK(names.insert(key.dotted()).second);
    CHECK(!key.range.empty());
    CHECK(!key.meaning.empty());
    CHECK(!key.unit.empty());
    // The default, written back, changes nothing; where it is out of range (0 for a modulus that must be given) or
    // absent, it is refused.
    Specimen specimen = two_materials();
    if (key.initial.empty()) continue;
    const Specimen before = specimen;
    const std::string message = input_error([&] { keys::set_key(specimen, key.dotted() + "=" + key.initial); });
    if (key.name == "name") continue;
    CHECK(differences(before, specimen) == 0);
    if (!message.empty()) CHECK_THAT(message, Contains("out of range"));
  }
}

TEST_CASE("assignments reach their fields") {
  Specimen s = two_materials();
  for (const char* assignment :
       {"contact.law=hertz_stiffness", "contact.slip = full_radius_ratcheting", "contact.rolling=true",
        "contact.unload_rescale=false", "contact.hertz_radius='curvature'", "material.friction=0.25",
        "material.gravel.density_kg_m3=2700", "material.normal_stiffness_N_m1_5=2e7",
        "material.tangential_stiffness_N_m=2_000_000", "damping.local=0.1", "damping.local_form='component'",
        "damping.dashpot=\"coefficient\"", "damping.normal_coefficient_N_s_m=20", "damping.no_tension=true",
        "solver.fixed_substeps=17", "solver.skin=0.2", "solver.fixed_time_step_s=1e-5", "solver.energy_balance=true",
        "material.sand.rolling_friction=0.05"}) {
    CAPTURE(assignment);
    keys::set_key(s, assignment);
  }
  CHECK(s.contact.law == Law::hertz_stiffness);
  CHECK(s.contact.slip == Slip::full_radius_ratcheting);
  CHECK(s.contact.rolling);
  CHECK(!s.contact.unload_rescale);
  CHECK(s.contact.hertz_radius == HertzRadius::curvature);
  CHECK(s.materials[0].friction == 0.25);
  CHECK(s.materials[1].friction == 0.25);
  CHECK(s.materials[0].density == 2650);
  CHECK(s.materials[1].density == 2700);
  CHECK(s.materials[1].normal_stiffness == 2e7);
  CHECK(s.materials[0].tangential_stiffness == 2e6);
  CHECK(s.materials[0].rolling_friction == 0.05);
  CHECK(s.materials[1].rolling_friction == 0);
  CHECK(s.damping.local == 0.1);
  CHECK(s.damping.local_form == LocalDampingForm::component);
  CHECK(s.damping.dashpot == Dashpot::coefficient);
  CHECK(s.damping.normal_coefficient == 20);
  CHECK(s.damping.no_tension);
  CHECK(s.solver.fixed_substeps == 17);
  CHECK(s.solver.skin == 0.2);
  CHECK(s.solver.fixed_time_step == 1e-5);
  CHECK(s.solver.energy_balance);
}

TEST_CASE("a friction angle gives its tangent as friction") {
  Specimen s = two_materials();
  keys::set_key(s, "material.friction_angle_deg=45");
  CHECK(s.materials[1].friction == Approx(1.0).epsilon(1e-15));
  keys::set_key(s, "material.sand.friction_angle_deg=30");
  CHECK(s.materials[0].friction == Approx(1 / std::sqrt(3.0)).epsilon(1e-15));
  CHECK_THAT(refused("material.friction_angle_deg=90"), Contains("90") && Contains("0 to below 90 degree"));
}

TEST_CASE("numbers must be finite and in range, whole where they count, and of their kind") {
  CHECK_THAT(refused("material.friction=nan"), Contains("material.friction = nan"));
  CHECK_THAT(refused("solver.skin=inf"), Contains("not finite"));
  CHECK_THAT(refused("material.friction=-0.1"), Contains("-0.1") && Contains("out of range") && Contains("0 to 1e+06"));
  CHECK_THAT(refused("material.poisson_ratio=0.6"), Contains("0.6") && Contains("-0.99 to 0.5"));
  CHECK_THAT(refused("damping.local=1"), Contains("0 to below 1"));
  CHECK_THAT(refused("damping.local_quasi_static=0"), Contains("above 0 to below 1"));
  CHECK_THAT(refused("damping.restitution=0"), Contains("above 0 to 1"));
  CHECK_THAT(refused("material.density_kg_m3=0"), Contains("> 0 kg/m^3"));
  CHECK_THAT(refused("solver.fixed_substeps=10.5"), Contains("10.5"));
  CHECK_THAT(refused("solver.fixed_substeps=-1"), Contains("out of range"));
  CHECK_THAT(refused("material.friction=rough"), Contains("'rough'") && Contains("not a number"));
  CHECK_THAT(refused("contact.rolling=1"), Contains("true or false"));
  CHECK_THAT(refused("contact.slip=sliding"), Contains("sliding") && Contains("full_radius_ratcheting"));
  CHECK_THAT(refused("contact.hertz_radius=mean"), Contains("mean") && Contains("equivalent, curvature"));
  CHECK_THAT(refused("contact.law=3"), Contains("not a word") && Contains("hertz_mindlin"));
  CHECK_THAT(refused("contact.law"), Contains("key=value"));
  CHECK_THAT(refused("contact.law="), Contains("hertz_mindlin"));
}

TEST_CASE("an unknown key is answered with the nearest known one") {
  CHECK_THAT(refused("contact.slp=consistent"), Contains("unknown key contact.slp") && Contains("is contact.slip;"));
  CHECK_THAT(refused("material.sand.frictoin=0.3"), Contains("is material.sand.friction;"));
  CHECK_THAT(refused("young_modulus_MPa=100"), Contains("write material.young_modulus_Pa, 1 MPa = 1e6 Pa"));
  CHECK_THAT(refused("solver.maxsubsteps=9"), Contains("is solver.max_substeps;"));
  CHECK_THAT(refused("solver.tolerance=9"), Contains("is solver.relative_tolerance;"));
  CHECK_THAT(refused("solver.gravity=9"), Contains("no known key is near") && !Contains("nearest"));
  CHECK_THAT(refused("material.silt.friction=0.3"), Contains("silt") && Contains("sand, gravel"));
  CHECK(keys::nearest("kitten", {"sitting", "mitten", "bitten"}) == "mitten");
  CHECK(keys::nearest("x", {}).empty());
}

TEST_CASE("a stiffness in the unit of another law is refused") {
  Specimen s = two_materials();
  keys::set_key(s, "contact.law=hertz_stiffness");
  CHECK_THAT(input_error([&] { keys::set_key(s, "material.normal_stiffness_N_m=1e6"); }),
             Contains("hertz_stiffness") && Contains("normal_stiffness_N_m1_5"));
  keys::set_key(s, "damping.dashpot=viscoelastic");
  CHECK_THAT(input_error([&] { keys::set_key(s, "damping.normal_coefficient_N_s_m=20"); }),
             Contains("viscoelastic_1_m_s"));
}

TEST_CASE("a key of a material that belongs to another contact law is refused, with the laws that read it") {
  const std::string rough =
      "[[material]]\nname = \"sand\"\nyoung_modulus_Pa = 7e10\npoisson_ratio = 0.2\nroughness_m = 3e-7\n";
  Specimen s;
  CHECK_THAT(read_file(rough + "[contact]\nlaw = \"hertz_mindlin\"\n", s),
             Contains("m.toml:5: material.roughness_m does not go with contact.law = hertz_mindlin") &&
                 Contains("allowed: with hertz_rough; remove the key, or set contact.law"));
  CHECK(read_file(rough + "[contact]\nlaw = \"hertz_rough\"\n", s).empty());
  CHECK_THAT(read_file("[[material]]\nstiffness_ratio = 0.5\n[contact]\nlaw = \"cones\"\n", s),
             Contains("m.toml:2: material.stiffness_ratio") && Contains("linear"));

  // What is 0 says nothing: texts with the keys of all laws are read.
  CHECK(read_file(rough + "stiffness_ratio = 0\nadhesion_Pa = 0.0\n[contact]\nlaw = \"hertz_rough\"\n", s).empty());

  // Assignments, in whatever order the law comes.
  s = two_materials();
  keys::set_keys(s, {"material.gravel.roughness_m=1e-7", "contact.law=hertz_rough"});
  CHECK(s.materials[1].roughness == 1e-7);
  CHECK_THAT(input_error([&] {
               keys::set_keys(s, {"contact.law=cones", "material.gravel.roughness_m=1e-7"});
             }),
             Contains("material.gravel.roughness_m") && Contains("cones") && Contains("hertz_rough"));

  // Over a file of another law the command line sets the law: keys of the file are not those of the command line.
  const auto mistakes = [](const std::string& key) {
    toml::table file = keys::parse_toml_text(
        "[contact]\nlaw = \"linear\"\n[[material]]\nname = \"sand\"\nstiffness_ratio = 0.5\n", "m.toml");
    std::vector<keys::KeyError> errors;
    keys::assign_all(file, {"contact.law=hertz_mindlin", "material.sand." + key}, errors);
    Specimen specimen;
    keys::read_material_tables(file, specimen, errors);
    return errors.size();
  };
  CHECK(mistakes("poisson_ratio=0.2") == 0);
  CHECK(mistakes("cone_slope=0.1") == 1);
}

TEST_CASE("a material file sets what it says, in whatever order its tables come") {
  Specimen s;
  CHECK(read_file("[[material]]\nname = \"sand\"\nnormal_stiffness_N_m1_5 = 20000000\nfriction = 0.3\n"
                  "tangential_stiffness_N_m = 2e6\n"
                  "[[material]]\nname = \"gravel\"\nfriction_angle_deg = 45\n"
                  "[damping]\nlocal = 0\ndashpot = \"coefficient\"\nnormal_coefficient_N_s_m = 20\n"
                  "[contact]\nlaw = \"hertz_stiffness\"\nslip = \"full_radius\"\n"
                  "[solver]\nskin = 0.05\n",
                  s)
            .empty());
  REQUIRE(s.materials.size() == 2);
  CHECK(s.materials[0].normal_stiffness == 2e7);
  CHECK(s.materials[1].friction == Approx(1).epsilon(1e-15));
  CHECK(s.contact.law == Law::hertz_stiffness);
  CHECK(s.contact.slip == Slip::full_radius);
  CHECK(s.damping.normal_coefficient == 20);
  CHECK(s.solver.skin == 0.05);
  Specimen one;
  CHECK(read_file("[material]\nfriction = 0.5\n", one).empty());
  REQUIRE(one.materials.size() == 1);
  CHECK(one.materials[0].friction == 0.5);
}

TEST_CASE("all mistakes of a file come at once, in the order of their lines") {
  Specimen s;
  const std::string message = read_file(
      "[solver]\nskn = 0.1\n\n[[material]]\nfriction = -1\nfriction_angle_deg = 20\n[[material]]\ndensity = 2650\n"
      "[contct]\nlaw = \"linear\"\n",
      s);
  std::vector<std::string> lines;
  std::istringstream text(message);
  for (std::string line; std::getline(text, line);) lines.push_back(line.substr(line.find("m.toml")));
  REQUIRE(lines.size() == 6);
  CHECK_THAT(lines[0], StartsWith("m.toml:2: ") && Contains("solver.skn") && Contains("solver.skin"));
  CHECK_THAT(lines[1], StartsWith("m.toml:5: ") && Contains("material.friction = -1"));
  CHECK_THAT(lines[2], StartsWith("m.toml:6: ") && Contains("both given"));
  CHECK_THAT(lines[3], StartsWith("m.toml:7: ") && Contains("\"grain\" is there twice"));
  CHECK_THAT(lines[4], StartsWith("m.toml:8: ") && Contains("material.density_kg_m3"));
  CHECK_THAT(lines[5], StartsWith("m.toml:9: ") && Contains("[contct]") && Contains("[contact]"));
}

TEST_CASE("a file that is no TOML, or not there, is named") {
  Specimen s;
  CHECK_THAT(read_file("[contact]\nlaw = linear\n", s), Contains("m.toml:2"));
  CHECK_THAT(read_file("material = 3\n", s), Contains("m.toml:1"));
  CHECK_THAT(input_error([&] { keys::read_material_file("none.toml", s); }), Contains("none.toml: no such file"));
}

TEST_CASE("a protocol's material table acts on all materials, or on the one it names") {
  Specimen s = two_materials();
  const auto file = toml::parse("[material]\nfriction = 0.1\n[material.gravel]\nrolling_friction = 0.2\nroling = 1\n");
  std::vector<keys::KeyError> errors;
  keys::read_table(s, "material", *file["material"].as_table(), errors);
  CHECK(s.materials[0].friction == 0.1);
  CHECK(s.materials[1].friction == 0.1);
  CHECK(s.materials[0].rolling_friction == 0);
  CHECK(s.materials[1].rolling_friction == 0.2);
  REQUIRE(errors.size() == 1);
  CHECK(errors[0].line == 5);
  CHECK_THAT(errors[0].message, Contains("material.gravel.roling"));
}

TEST_CASE("a key of more names than tables are deep is refused with its line, wherever it stands") {
  const Folder folder;
  std::string dotted;
  for (int k = 0; k < 50'000; ++k) dotted += "a.";
  for (const std::string& text : {dotted + "b = 1\n", "[" + dotted + "b]\n", "[[" + dotted + "b]]\n",
                                  "x = {" + dotted + "b = 1}\n", "x = [\n{" + dotted + "b = 1}]\n"}) {
    write_bytes(folder / "m.toml", "[contact]\nlaw = \"linear\"\n" + text);
    CHECK_THAT(input_error([&] { keys::parse_toml_file(folder / "m.toml"); }),
               Contains(text.starts_with("x = [\n") ? "m.toml:4: " : "m.toml:3: ") && Contains("more than 8 names"));
  }
  Specimen specimen = two_materials();
  CHECK(input_error([&] { keys::set_key(specimen, "contact.law={" + dotted + "b=1}"); }).size() < 500);
  const std::string quoted = "a = \"" + dotted + "\" # " + dotted + "\nb = '''\n" + dotted + "'''\nc = \"\\\"" +
                             dotted +
                             "\"\nd = [1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5]\n\"e.e.e.e.e.e.e.e.e\".f = 1\n";
  write_bytes(folder / "m.toml", quoted);
  CHECK(keys::parse_toml_file(folder / "m.toml").size() == 5);
}

TEST_CASE("a text that is refused is quoted by its beginning") {
  Specimen specimen = two_materials();
  for (const std::string& assignment :
       {"contact.law=" + std::string(70'000, 'x'), "contact." + std::string(70'000, 'x') + "=1"}) {
    const std::string message = input_error([&] { keys::set_key(specimen, assignment); });
    CHECK_THAT(message, Contains("xxx...") || Contains("xxx"));
    CHECK(message.size() < 600);
  }
}
