// Scenes of rocks that mean nothing are refused: key, value and remedy are told.
#include "tests/mpm/rock_scenes.hpp"

using namespace mpm;
using namespace mpm::test;
using Catch::Matchers::Contains;

TEST_CASE("scenes with rocks in soil, in the plane and in space, are accepted as they stand") {
  CHECK(outcome(rocks_in_plane) == "accepted");
  CHECK(outcome(rocks_in_space) == "accepted");
  CHECK(with_table(rocks_in_plane, "x,y,r\n1,9,0.4\n2,9,0.3\n") == "accepted");
  CHECK(outcome(rocks_in_space, with_stl(pyramid(6))) == "accepted");
}

TEST_CASE("rocks that stand in each other, in a boundary or in a body are refused by name") {
  expect_said(rocks_in_plane,
              {{set("rock.slab.centre_m=[1.2, 1.6]"), {"rock.disc", "rock.slab", "at the start", "move one"}},
               // One wholly in the other.
               {set({"rock.slab.centre_m=[1, 1.5]", "rock.slab.half_axes_m=[1, 0.9]"}), {"in rock.slab"}},
               {set("rock.disc.centre_m=[0.3, 1.5]"), {"rock.disc", "0.1 m", "boundary.left", "move one"}},
               {set("rock.slab.centre_m=[-3, 1.5]"), {"rock.slab", "3.5 m", "boundary.left"}},
               {set("rock.disc.centre_m=[3, 2.5]"), {"rock.disc", "0.15 m", "body.beam"}},
               {set("rock.slab.centre_m=[3, 2.6]"), {"rock.slab", "body.beam"}},
               {set({"rock.disc.centre_m=[3, 3]", "rock.disc.radius_m=0.2"}), {"body.beam"}},
               // Touching is no overlap.
               {set("rock.disc.centre_m=[0.4, 1.5]"), {"accepted"}}});
  CHECK_THAT(with_table(rocks_in_plane, "1,9,0.4\n1.5,9,0.4\n"), Contains("of rocks.table") && Contains("0.3 m"));
}

TEST_CASE("rocks too small for the soil are refused with the size that will do") {
  // Points of 0.125 m: 0.3125 m and more.
  expect_said(rocks_in_plane, {{set("rock.disc.radius_m=0.15"), {"rock.disc", "0.3 m", "0.125 m", "make it larger"}},
                               {set("rock.disc.radius_m=0.16"), {"accepted"}}});
}

TEST_CASE("what the method has no answer for is refused beside rocks") {
  expect_said(
      rocks_in_plane,
      {{set("loads.surface_pressure_Pa=1000"), {"loads.surface_pressure_Pa", "do not go together"}},
       {set("fluid={conductivity_m_s=1e-3, porosity=0.4}"), {"[fluid] and rocks", "remove one"}},
       {edit("kind = \"roller\"\naxis = \"x\"\nat_m = 0\n", "kind = \"periodic\"\naxis = \"x\"\nat_m = 0\nto_m = 4\n"),
        {"boundary.left is periodic", "make it a roller"}},
       {set("loads.shaking={axis=\"x\", record=[[0, 0], [1, 1]]}"), {"do not go together"}}});
}

TEST_CASE("materials of rocks: a density, a name that is known, numbers in their range") {
  expect_said(
      rocks_in_plane,
      {{edit("density_kg_m3 = 2700\n", ""), {"rock_material.density_kg_m3 is missing"}},
       {set("rock_material.basalt.density_kg_m3=0"), {"density_kg_m3 = 0", "range"}},
       {set("rock_material.basalt.density_kg_m3=-1"), {"density_kg_m3 = -1", "range"}},
       {set("rock_material.basalt.restitution=2"), {"rock_material.restitution = 2", "allowed: 0 to 1"}},
       {set("rock_material.basalt.poisson_ratio=0.6"), {"poisson_ratio = 0.6", "allowed: -0.99 to 0.5"}},
       {set("rock.disc.material=basult"), {"rock.material is \"basult\"", "nearest is basalt"}},
       {set("rocks.coarse.material=granite"), {"rocks.material is \"granite\"", "allowed: basalt"}},
       {edit("[[rock_material]]",
             "[[rock_material]]\nname = \"basalt\"\ndensity_kg_m3 = 1\nyoung_modulus_Pa = 1\n[[rock_material]]"),
        {"rock_material.name is \"basalt\"", "rename one"}}});
}

TEST_CASE("shapes of rocks: sizes, blockiness, turns and held axes that are none") {
  for (const char* bad : {"1.9", "51", "-4"})
    expect_said(rocks_in_plane, {{set("rock.slab.blockiness=[" + std::string(bad) + "]"),
                                  {"rock.blockiness holds " + std::string(bad), "allowed: 2 (round) to 50 (a box)"}}});
  expect_said(rocks_in_plane,
              {{set("rock.slab.half_axes_m=[0.5, 0]"), {"rock.half_axes_m holds 0", "range"}},
               {set("rock.slab.half_axes_m=[0.5, 0.3, 0.3]"), {"rock.half_axes_m must be 2 numbers"}},
               {set("rock.disc.radius_m=-1"), {"rock.radius_m = -1", "range"}},
               {set("rock.disc.held=[\"w\"]"), {"rock.held names \"w\"", "allowed: x, y, rotation"}},
               {set("rock.disc.held=[\"z\"]"), {"rock.held names \"z\"", "allowed: x, y, rotation"}},
               // Space in the plane.
               {set("rock.disc.shape=polyhedron"), {"rock.shape = ", "polyhedron", "allowed: sphere, superquadric"}},
               {set("rock.disc.centre_m=[1, 1.5, 0]"), {"rock.centre_m must be 2 numbers"}}});
  expect_said(rocks_in_space, {{edit("centre_m", "rotation_deg = [0, 0, 0, 30]\ncentre_m"),
                                {"rock.rotation_deg has no axis", "give [x, y, z, angle]"}},
                               {edit("centre_m", "rotation_deg = 30\ncentre_m"), {"rock.rotation_deg", "list"}}});
}

TEST_CASE("numbers of rocks that are none or not finite are refused") {
  for (const char* key :
       {"rock.disc.centre_m=[1, nan]", "rock.disc.velocity_m_s=[inf, 0]", "rock.slab.half_axes_m=[inf, 1]",
        "rock.slab.blockiness=[nan]", "rocks.coarse.lower_m=[nan, 0]", "rocks.coarse.diameters_m=[[nan, 1]]"})
    expect_said(rocks_in_plane, {{set(key), {"give a finite number"}}});
  for (const char* key :
       {"rock.disc.radius_m", "rock.disc.spin_rad_s", "rock.disc.rotation_deg", "rock_material.basalt.young_modulus_Pa",
        "rock_material.basalt.friction", "rocks.coarse.volume_share", "rocks.coarse.gap_m", "rock_soil.friction"}) {
    for (const std::string value : {"nan", "inf"})
      expect_said(rocks_in_plane, {{set(std::string(key) + "=" + value), {" = " + value, "allowed: "}}});
  }
}

TEST_CASE("keys of rocks that are misspelt are told with the nearest one that is known") {
  const struct {
    const char *from, *to, *unknown, *nearest;
  } cases[] = {
      {"density_kg_m3 = 2700", "densty_kg_m3 = 2700", "rock_material.densty_kg_m3", "rock_material.density_kg_m3"},
      {"radius_m", "radus_m", "rock.radus_m", "rock.radius_m"},
      {"half_axes_m", "half_axis_m", "rock.half_axis_m", "rock.half_axes_m"},
      {"centre_m = [1, 1.5]", "center_m = [1, 1.5]", "rock.center_m", "rock.centre_m"},
      {"volume_share", "volume_shar", "rocks.volume_shar", "rocks.volume_share"},
      {"diameters_m", "diametres_m", "rocks.diametres_m", "rocks.diameters_m"},
      {"friction = 0.5", "frictoin = 0.5", "rock_soil.frictoin", "rock_soil.friction"},
      {"[rock_soil]", "[rocksoil]", "rocksoil", "rock_soil"},
      {"[[rock]]\nname = \"disc\"", "[[rok]]\nname = \"disc\"", "rok", "rock"},
      // Without its shape the slab is a sphere: its keys are unknown too.
      {"shape = \"sup", "shpe = \"sup", "rock.shpe", "rock.shape"}};
  const auto words = [](const std::string& unknown, const std::string& nearest) {
    return std::vector<std::string>{"unknown key " + unknown + "; the nearest known key is " + nearest};
  };
  for (const auto& each : cases)
    expect_said(rocks_in_plane, {{edit(each.from, each.to), words(each.unknown, each.nearest)}});
  expect_said(rocks_in_space, {{with_stl(pyramid(6), "file_stll"), words("rock.file_stll", "rock.file_stl")}});
  expect_said(rocks_in_plane + rocks("b", "tabel = \"rocks.csv\"\n"), {{{}, words("rocks.tabel", "rocks.table")}});
}

TEST_CASE("rocks to be drawn that do not fit, or are none, are refused") {
  expect_said(rocks_in_plane,
              {{set("rocks.coarse.volume_share=0.7"), {"rocks.volume_share is 0.7", "up to 0.6"}},
               {set({"rocks.coarse.volume_share=0.6", "rocks.coarse.diameters_m=[[2.5, 1]]"}),
                {"rocks.coarse.volume_share = 0.6", "make volume_share or gap_m smaller"}},
               {set("rocks.coarse.volume_share=0.001"), {"rocks.coarse.volume_share = 0.001", "less than one rock"}},
               {set("rocks.coarse.diameters_m=[]"), {"rocks.diameters_m", "[diameter in m, part by volume]"}},
               {set({"rocks.coarse.diameters_m=[[4.4, 1]]", "rocks.coarse.volume_share=0.6"}),
                {"rocks.coarse.diameters_m", "4.4 m", "does not fit between lower_m and upper_m"}},
               {set("rocks.coarse.diameters_m=[[0.8, 0]]"), {"rocks.diameters_m", "[0.8, 0]", "not positive"}},
               {set("rocks.coarse.diameters_m=[0.8]"), {"rocks.diameters_m", "rows of 2 numbers"}},
               {set("rocks.coarse.diameters_m=[[1e-4, 1]]"), {"take larger ones"}},
               {set("rocks.coarse.upper_m=[4, 4]"), {"rocks.upper_m must be above lower_m"}},
               {set("rocks.coarse.aspect=[1, 0]"), {"rocks.aspect holds 0", "0.001 to 1000"}},
               {set("rocks.coarse.seed=-1"), {"rocks.seed = -1", "allowed: 0 to "}},
               {set("rocks.coarse.rotation_deg=30"), {"rocks.rotation_deg", "aligned"}}});
}

TEST_CASE("tables and STL files of rocks that are not there, or hold something else, are refused") {
  const struct {
    const char *rows, *words;
  } tables[] = {{"x,y,r\n1,9,0.4\n2,big,0.4\n", "rocks.csv:3: holds big"},
                {"1,9,0.o4\n2,9,0.4\n", "rocks.csv:1: holds 0.o4"},  // numbers but for one: no header
                {"1,9,0.4\n2,9,-\n", "rocks.csv:2: holds -"},
                {"1,9,0.4\n2,nan,0.4\n", "rocks.csv:2: holds nan"},
                {"1,9,0.4\n2,9,1e999\n", "rocks.csv:2: holds 1e999"},
                {"x,y,r\n", "rocks.csv: holds no rows of numbers"},
                {"1,9,0.4,0.4\n", "rows of 4 numbers; give x, y, radius, or"},
                {"1,9,0.4\n2,9\n", "rows of 3 numbers"},
                {"1,9,-0.4\n", "size -0.4; sizes must be positive"}};
  for (const auto& each : tables) CHECK_THAT(with_table(rocks_in_plane, each.rows), Contains(each.words));
  CHECK_THAT(with_table(rocks_in_space, "0.5,0.5,3,0.3,0.3,0.3,0,0,0,0\n"), Contains("quaternion of length 0"));
  expect_said(rocks_in_plane + rocks("b", "table = \"none.csv\"\n"), {{{}, {"none.csv: no such file", "rocks.table"}}});
  const auto polyhedron = [](const std::string& more) {
    return edit("radius_m = 0.4", "shape = \"polyhedron\"\n" + more);
  };
  expect_said(rocks_in_space, {{polyhedron("file_stl = \"none.stl\""), {"none.stl"}},
                               {polyhedron(""), {"rock.file_stl is missing"}},
                               {polyhedron("file_stl = 3"), {"rock.file_stl = 3", "text"}},
                               // A pyramid without its last side, and its base alone.
                               {with_stl(pyramid(5)), {"rock.stl", "not closed"}},
                               {with_stl(pyramid(2)), {"rock.stl", "four or more"}},
                               {with_stl(""), {"rock.stl"}}});
}

TEST_CASE("contact of rocks and soil: keys that exclude or want each other, and no rocks to touch") {
  for (const char* key : {"porosity=0.4", "young_modulus_Pa=1e9", "poisson_ratio=0.2", "moment=false"})
    expect_said(rocks_in_plane, {{set("rock_soil." + std::string(key)), {"contact = \"ghost\"", "remove it"}}});
  expect_said(rocks_in_plane,
              {{set("rock_soil.rough=true"), {"rock_soil.friction", "rough = true", "remove one"}},
               {set({"rock_soil.porosity=0.4", "rock_soil.contact=ghost"}), {"accepted"}},
               {set({"rock_soil.poisson_ratio=0.4", "rock_soil.contact=ghost"}), {"poisson_ratio", "young_modulus_Pa"}},
               {set("rock_soil.contact=gost"), {"rock_soil.contact", "nearest is ghost"}}});
  const auto without = rocks_in_plane.substr(0, rocks_in_plane.find("[[rock]]"));
  expect_said(without + "[rock_soil]\nfriction = 0.5\n", {{{}, {"[rock_soil]", "no rock; add [[rock]]"}}});
  expect_said(without, {{{}, {"[[rock_material]]", "no rock; add [[rock]]"}}});
}

TEST_CASE("rocks, boundaries and bodies are told apart by their names") {
  const auto from = rocks_in_plane.find("[[rocks]]");
  const auto again = rocks_in_plane.substr(from, rocks_in_plane.find("[rock_soil]") - from);
  expect_said(rocks_in_plane,
              {{set("rock.slab.name=disc"), {"two boundaries, bodies or rocks are called disc", "rename one"}},
               {set("rock.slab.name=beam"), {"two boundaries, bodies or rocks are called beam"}},
               {set("rock.slab.name=\"a b\""), {"rock.name is \"a b\"", "letters, digits, _ and -"}},
               {edit("[[rocks]]", again + "[[rocks]]"), {"rocks.name is \"coarse\"", "rename one"}}});
}
