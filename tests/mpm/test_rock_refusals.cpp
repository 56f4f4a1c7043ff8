// Scenes of rocks that mean nothing are refused: key, value and remedy are told.
#include "tests/catch.hpp"
#include "tests/mpm/rock_refusals.hpp"

using namespace mpm;
using namespace mpm::test;
using Catch::Matchers::Contains;

TEST_CASE("scenes with rocks in soil, in the plane and in space, are accepted as they stand") {
  CHECK(rocks_with({}) == "accepted");
  CHECK(in_space("", "") == "accepted");
  CHECK(with_table(rocks_in_plane, "x,y,r\n1,9,0.4\n2,9,0.3\n") == "accepted");
  CHECK(with_stl(pyramid(6)) == "accepted");
}

TEST_CASE("rocks that stand in each other, in a boundary or in a body are refused by name") {
  CHECK_THAT(rocks_with({"rock.slab.centre_m=[1.2, 1.6]"}), Contains("rock.disc: stands ") &&
                                                                Contains(" m in rock.slab") &&
                                                                Contains("at the start; move one of them"));
  // One wholly in the other.
  CHECK_THAT(rocks_with({"rock.slab.centre_m=[1, 1.5]", "rock.slab.half_axes_m=[1, 0.9]"}), Contains("in rock.slab"));
  CHECK_THAT(rocks_with({"rock.disc.centre_m=[0.3, 1.5]"}),
             Contains("rock.disc: stands 0.1 m in boundary.left at the start; move one of them"));
  CHECK_THAT(rocks_with({"rock.slab.centre_m=[-3, 1.5]"}), Contains("rock.slab: stands 3.5 m in boundary.left"));
  CHECK_THAT(rocks_with({"rock.disc.centre_m=[3, 2.5]"}), Contains("rock.disc: stands 0.15 m in body.beam"));
  CHECK_THAT(rocks_with({"rock.slab.centre_m=[3, 2.6]"}), Contains("rock.slab: stands ") && Contains("in body.beam"));
  CHECK_THAT(rocks_with({"rock.disc.centre_m=[3, 3]", "rock.disc.radius_m=0.2"}), Contains("in body.beam"));
  // Touching is no overlap.
  CHECK(rocks_with({"rock.disc.centre_m=[0.4, 1.5]"}) == "accepted");
  CHECK_THAT(with_table(rocks_in_plane, "1,9,0.4\n1.5,9,0.4\n"),
             Contains(" of rocks.table: stands 0.3 m in rock ") && Contains("of rocks.table at the start"));
}

TEST_CASE("rocks too small for the soil are refused with the size that will do") {
  // Points of 0.125 m: 0.3125 m and more.
  CHECK_THAT(rocks_with({"rock.disc.radius_m=0.15"}),
             Contains("rock.disc: is 0.3 m across, and the soil's points 0.125 m") &&
                 Contains("two and a half points") && Contains("make it larger, or grid.cell_m smaller"));
  CHECK(rocks_with({"rock.disc.radius_m=0.16"}) == "accepted");
}

TEST_CASE("what the method has no answer for is refused beside rocks") {
  CHECK_THAT(rocks_with({"loads.surface_pressure_Pa=1000"}),
             Contains("loads.surface_pressure_Pa") && Contains("do not go together"));
  CHECK_THAT(rocks_with({"fluid={conductivity_m_s=1e-3, porosity=0.4}"}),
             Contains("[fluid] and rocks do not go together yet; remove one of them"));
  CHECK_THAT(rocks_edited("kind = \"roller\"\naxis = \"x\"\nat_m = 0\n",
                          "kind = \"periodic\"\naxis = \"x\"\nat_m = 0\nto_m = 4\n"),
             Contains("boundary.left is periodic, and rocks do not cross it; make it a roller"));
  CHECK_THAT(rocks_with({"loads.shaking={axis=\"x\", record=[[0, 0], [1, 1]]}"}), Contains("do not go together yet"));
}

TEST_CASE("materials of rocks: a density, a name that is known, numbers in their range") {
  CHECK_THAT(rocks_edited("density_kg_m3 = 2700\n", ""), Contains("the key rock_material.density_kg_m3 is missing"));
  CHECK_THAT(rocks_with({"rock_material.basalt.density_kg_m3=0"}), Contains("density_kg_m3 is 0; it must be positive"));
  CHECK_THAT(rocks_with({"rock_material.basalt.density_kg_m3=-1"}),
             Contains("density_kg_m3 is -1; it must be positive"));
  CHECK_THAT(rocks_with({"rock_material.basalt.restitution=2"}),
             Contains("rock_material.restitution is 2; allowed: 0 to 1"));
  CHECK_THAT(rocks_with({"rock_material.basalt.poisson_ratio=0.6"}),
             Contains("poisson_ratio is 0.6; allowed: -0.99 to 0.5"));
  CHECK_THAT(rocks_with({"rock.disc.material=basult"}),
             Contains("rock.material is \"basult\"; the nearest rock_material is \"basalt\""));
  CHECK_THAT(rocks_with({"rocks.coarse.material=granite"}), Contains("rocks.material is \"granite\"; the nearest"));
  CHECK_THAT(rocks_edited("[[rock_material]]",
                          "[[rock_material]]\nname = \"basalt\"\ndensity_kg_m3 = 1\nyoung_modulus_Pa = "
                          "1\n[[rock_material]]"),
             Contains("rock_material.name is \"basalt\"") && Contains("rename one"));
}

TEST_CASE("shapes of rocks: sizes, blockiness, turns and held axes that are none") {
  for (const char* bad : {"1.9", "51", "-4", "nan"}) {
    CAPTURE(bad);
    CHECK_THAT(rocks_with({"rock.slab.blockiness=[" + std::string(bad) + "]"}),
               Contains("rock.blockiness holds " + std::string(bad)));
  }
  CHECK_THAT(rocks_with({"rock.slab.blockiness=[51]"}), Contains("allowed: 2 (round) to 50 (a box)"));
  CHECK_THAT(rocks_with({"rock.slab.half_axes_m=[0.5, 0]"}), Contains("rock.half_axes_m is 0; it must be positive"));
  CHECK_THAT(rocks_with({"rock.slab.half_axes_m=[0.5, 0.3, 0.3]"}), Contains("rock.half_axes_m must be 2 numbers"));
  CHECK_THAT(rocks_with({"rock.disc.radius_m=-1"}), Contains("rock.radius_m is -1; it must be positive"));
  CHECK_THAT(rocks_with({"rock.disc.held=[\"w\"]"}), Contains("rock.held names \"w\"; allowed: x, y, rotation"));
  CHECK_THAT(rocks_with({"rock.disc.held=[\"z\"]"}), Contains("rock.held names \"z\"; allowed: x, y, rotation"));
  CHECK_THAT(in_space("centre_m", "rotation_deg = [0, 0, 0, 30]\ncentre_m"),
             Contains("rock.rotation_deg has no axis; give [x, y, z, angle]"));
  CHECK_THAT(in_space("centre_m", "rotation_deg = 30\ncentre_m"), Contains("rock.rotation_deg must be 4 numbers"));
  // Space in the plane.
  CHECK_THAT(rocks_with({"rock.disc.shape=polyhedron"}),
             Contains("rock.shape is \"polyhedron\"") && Contains("allowed: sphere, superquadric"));
  CHECK_THAT(rocks_with({"rock.disc.centre_m=[1, 1.5, 0]"}), Contains("rock.centre_m must be 2 numbers"));
}

TEST_CASE("numbers of rocks that are none or not finite are refused") {
  for (const char* key :
       {"rock.disc.centre_m=[1, nan]", "rock.disc.velocity_m_s=[inf, 0]", "rock.slab.half_axes_m=[inf, 1]",
        "rocks.coarse.lower_m=[nan, 0]", "rocks.coarse.diameters_m=[[nan, 1]]"}) {
    CAPTURE(key);
    CHECK_THAT(rocks_with({key}), Contains("give numbers that are finite"));
  }
  for (const char* key :
       {"rock.disc.radius_m", "rock.disc.spin_rad_s", "rock.disc.rotation_deg", "rock_material.basalt.young_modulus_Pa",
        "rock_material.basalt.friction", "rocks.coarse.volume_share", "rocks.coarse.gap_m", "rock_soil.friction"}) {
    for (const char* value : {"nan", "inf"}) {
      CAPTURE(key, value);
      const auto said = rocks_with({std::string(key) + "=" + value});
      CHECK_THAT(said, Contains(std::string(" is ") + value) && Contains("allowed: "));
    }
  }
}

TEST_CASE("keys of rocks that are misspelt are told before those that are missing for it") {
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
      {"[[rock]]\nname = \"disc\"", "[[rok]]\nname = \"disc\"", "rok", "rock"}};
  for (const auto& each : cases) {
    CHECK_THAT(rocks_edited(each.from, each.to),
               Contains("unknown key " + std::string(each.unknown) + "; the nearest known key is " + each.nearest));
  }
  // Without its shape the slab is a sphere: its keys are unknown too.
  CHECK_THAT(rocks_edited("shape = \"sup", "shpe = \"sup"), Contains("rock.shpe (rock.shape)"));
  CHECK_THAT(with_stl(pyramid(6), "file_stll"),
             Contains("unknown key rock.file_stll; the nearest known key is rock.file_stl"));
  CHECK_THAT(told_of(rocks_in_plane + "\n[[rocks]]\nname = \"b\"\nmaterial = \"basalt\"\ntabel = \"rocks.csv\"\n", {}),
             Contains("unknown key rocks.tabel; the nearest known key is rocks.table"));
}

TEST_CASE("rocks to be drawn that do not fit, or are none, are refused") {
  CHECK_THAT(rocks_with({"rocks.coarse.volume_share=0.7"}), Contains("rocks.volume_share is 0.7; allowed: up to 0.6"));
  CHECK_THAT(rocks_with({"rocks.coarse.volume_share=0.6", "rocks.coarse.diameters_m=[[2.5, 1]]"}),
             Contains("rocks.coarse.volume_share = 0.6") && Contains("make volume_share or gap_m smaller"));
  CHECK_THAT(rocks_with({"rocks.coarse.volume_share=0.001"}),
             Contains("rocks.coarse.volume_share = 0.001 is less than one rock in the box"));
  CHECK_THAT(rocks_with({"rocks.coarse.diameters_m=[]"}),
             Contains("rocks.diameters_m") && Contains("[diameter in m, part by volume]"));
  CHECK_THAT(
      rocks_with({"rocks.coarse.diameters_m=[[4.4, 1]]", "rocks.coarse.volume_share=0.6"}),
      Contains("rocks.coarse.diameters_m") && Contains("a rock of 4.4 m does not fit between lower_m and upper_m"));
  CHECK_THAT(rocks_with({"rocks.coarse.diameters_m=[[0.8, 0]]"}),
             Contains("rocks.diameters_m has the row [0.8, 0], which is not positive"));
  CHECK_THAT(rocks_with({"rocks.coarse.diameters_m=[0.8]"}), Contains("rocks.diameters_m must be rows of 2 numbers"));
  CHECK_THAT(rocks_with({"rocks.coarse.diameters_m=[[1e-4, 1]]"}),
             Contains("take larger ones, or a smaller volume_share"));
  CHECK_THAT(rocks_with({"rocks.coarse.upper_m=[4, 4]"}),
             Contains("rocks.upper_m must be above lower_m along every axis"));
  CHECK_THAT(rocks_with({"rocks.coarse.aspect=[1, 0]"}),
             Contains("rocks.aspect holds 0; allowed: 0.001 to 1000 along every axis"));
  CHECK_THAT(rocks_with({"rocks.coarse.seed=-1"}), Contains("rocks.seed is -1; allowed: 0 to "));
  CHECK_THAT(rocks_with({"rocks.coarse.rotation_deg=30"}), Contains("rocks.rotation_deg") && Contains("aligned"));
}

TEST_CASE("tables and STL files of rocks that are not there, or hold something else, are refused") {
  CHECK_THAT(with_table(rocks_in_plane, "x,y,r\n1,9,0.4\n2,big,0.4\n"),
             Contains("rocks.csv:3: holds big") && Contains("correct or remove it"));
  // A first row of numbers but for one is no header.
  CHECK_THAT(with_table(rocks_in_plane, "1,9,0.o4\n2,9,0.4\n"), Contains("rocks.csv:1: holds 0.o4"));
  CHECK_THAT(with_table(rocks_in_plane, "1,9,0.4\n2,9,-\n"), Contains("rocks.csv:2: holds -"));
  CHECK_THAT(with_table(rocks_in_plane, "1,9,0.4\n2,nan,0.4\n"), Contains("rocks.csv:2: holds nan"));
  CHECK_THAT(with_table(rocks_in_plane, "1,9,0.4\n2,9,1e999\n"), Contains("rocks.csv:2: holds 1e999"));
  CHECK_THAT(with_table(rocks_in_plane, "x,y,r\n"), Contains("rocks.csv: holds no rows of numbers"));
  CHECK_THAT(with_table(rocks_in_plane, "1,9,0.4,0.4\n"), Contains("has rows of 4 numbers; give x, y, radius, or"));
  CHECK_THAT(with_table(rocks_in_plane, "1,9,0.4\n2,9\n"), Contains("must be rows of 3 numbers each"));
  CHECK_THAT(with_table(rocks_in_plane, "1,9,-0.4\n"), Contains("has a rock of size -0.4; sizes must be positive"));
  CHECK_THAT(with_table(rocks_in_space, "0.5,0.5,3,0.3,0.3,0.3,0,0,0,0\n"), Contains("quaternion of length 0"));
  CHECK_THAT(told_of(rocks_in_plane + "\n[[rocks]]\nname = \"b\"\nmaterial = \"basalt\"\ntable = \"none.csv\"\n", {}),
             Contains("none.csv: cannot be read") && Contains("rocks.table"));
  CHECK_THAT(in_space("radius_m = 0.4", "shape = \"polyhedron\"\nfile_stl = \"none.stl\""), Contains("none.stl"));
  CHECK_THAT(in_space("radius_m = 0.4", "shape = \"polyhedron\""), Contains("the key rock.file_stl is missing"));
  CHECK_THAT(in_space("radius_m = 0.4", "shape = \"polyhedron\"\nfile_stl = 3"),
             Contains("rock.file_stl must be a text"));
  // A pyramid without its last side, and its base alone.
  CHECK_THAT(with_stl(pyramid(5)), Contains("rock.ball.file_stl: ") && Contains("open"));
  CHECK_THAT(with_stl(pyramid(2)), Contains("rock.ball.file_stl: ") && Contains("at least 4"));
  CHECK_THAT(with_stl(""), Contains("rock.stl"));
}

TEST_CASE("contact of rocks and soil: keys that exclude or want each other, and no rocks to touch") {
  CHECK_THAT(rocks_with({"rock_soil.rough=true"}),
             Contains("rock_soil.friction and rough = true exclude each other; remove one"));
  for (const char* key : {"porosity=0.4", "young_modulus_Pa=1e9", "poisson_ratio=0.2", "moment=false"}) {
    CAPTURE(key);
    CHECK_THAT(rocks_with({"rock_soil." + std::string(key)}),
               Contains("is of contact = \"ghost\"; remove it, or set contact to that"));
  }
  CHECK(rocks_with({"rock_soil.porosity=0.4", "rock_soil.contact=ghost"}) == "accepted");
  CHECK_THAT(rocks_with({"rock_soil.poisson_ratio=0.4", "rock_soil.contact=ghost"}),
             Contains("rock_soil.poisson_ratio goes with young_modulus_Pa"));
  CHECK_THAT(rocks_with({"rock_soil.contact=gost"}), Contains("the nearest allowed value is \"ghost\""));
  const auto without = rocks_in_plane.substr(0, rocks_in_plane.find("[[rock]]"));
  CHECK_THAT(told_of(without + "[rock_soil]\nfriction = 0.5\n", {}),
             Contains("[rock_soil]") && Contains("no rock; add [[rock]]"));
  CHECK_THAT(told_of(without, {}), Contains("[[rock_material]]") && Contains("no rock; add [[rock]]"));
}

TEST_CASE("rocks, boundaries and bodies are told apart by their names") {
  CHECK_THAT(rocks_with({"rock.slab.name=disc"}),
             Contains("two boundaries, bodies or rocks are called disc") && Contains("rename one"));
  CHECK_THAT(rocks_with({"rock.slab.name=beam"}), Contains("two boundaries, bodies or rocks are called beam"));
  CHECK_THAT(rocks_with({"rock.slab.name=\"a b\""}),
             Contains("rock.name is \"a b\"") && Contains("letters, digits, _ and -"));
  const auto again = rocks_in_plane.substr(rocks_in_plane.find("[[rocks]]"),
                                           rocks_in_plane.find("[rock_soil]") - rocks_in_plane.find("[[rocks]]"));
  CHECK_THAT(rocks_edited("[[rocks]]", again + "[[rocks]]"),
             Contains("rocks.name is \"coarse\"") && Contains("rename one"));
}
