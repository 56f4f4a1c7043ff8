// Small scenes with rocks, and what is said of them when something in them is changed.
#pragma once

#include <fstream>

#include "tests/catch.hpp"
#include "tests/folder.hpp"
#include "tools/mpm/setup/setup.hpp"

namespace mpm::test {

inline constexpr const char* of_any_rocks = R"(
[time]
duration_s = 1
[[material]]
name = "soil"
kind = "elastic"
density_kg_m3 = 1500
young_modulus_Pa = 1e6
[[rock_material]]
name = "basalt"
density_kg_m3 = 2700
young_modulus_Pa = 1e8
)";
inline const std::string rocks_in_plane = std::string(of_any_rocks) + R"(
[scene]
name = "plane"
[grid]
cell_m = 0.25
[[region]]
material = "soil"
lower_m = [0, 0]
upper_m = [4, 1]
[[boundary]]
name = "left"
kind = "roller"
axis = "x"
at_m = 0
[[body]]
name = "beam"
kind = "box"
centre_m = [3, 3]
size_m = [1, 0.5]
[[rock]]
name = "disc"
material = "basalt"
radius_m = 0.4
centre_m = [1, 1.5]
[[rock]]
name = "slab"
material = "basalt"
shape = "superquadric"
half_axes_m = [0.5, 0.3]
blockiness = [4]
centre_m = [2.5, 1.5]
[[rocks]]
name = "coarse"
material = "basalt"
lower_m = [0, 4]
upper_m = [4, 8]
volume_share = 0.2
diameters_m = [[0.8, 1]]
[rock_soil]
friction = 0.5
)";
inline const std::string rocks_in_space = std::string(of_any_rocks) + R"(
[scene]
name = "space"
dimension = 3
[grid]
cell_m = 0.25
[[region]]
material = "soil"
lower_m = [0, 0, 0]
upper_m = [1, 1, 0.5]
[[rock]]
name = "ball"
material = "basalt"
radius_m = 0.4
centre_m = [0.5, 0.5, 1]
)";

/// What is said of a scene: assignments, and in its text `from` replaced by `to`. Tables and STL files by name.
struct Told {
  std::vector<std::string> assignments;
  std::string from, to;
  std::vector<std::pair<std::string, std::string>> files;
};

inline std::string told_of(std::string text, const Told& what) {
  const rvelab::test::Folder folder;
  if (!what.from.empty()) {
    REQUIRE(text.find(what.from) != std::string::npos);
    text.replace(text.find(what.from), what.from.size(), what.to);
  }
  std::ofstream(folder / "scene.toml") << text;
  for (const auto& [name, content] : what.files) std::ofstream(folder / name) << content;
  try {
    const auto scene = read_scene(folder / "scene.toml", {}, what.assignments);
    if (scene.dimension == 2) {
      set_up<2>(scene, 1, folder.path());
    } else {
      set_up<3>(scene, 1, folder.path());
    }
  } catch (const InputError& mistake) {
    return mistake.what();
  }
  return "accepted";
}
inline std::string rocks_with(const std::vector<std::string>& assignments) {
  return told_of(rocks_in_plane, {assignments, "", "", {}});
}
inline std::string rocks_edited(const std::string& from, const std::string& to) {
  return told_of(rocks_in_plane, {{}, from, to, {}});
}
inline std::string in_space(const std::string& from, const std::string& to) {
  return told_of(rocks_in_space, {{}, from, to, {}});
}
inline std::string with_table(const std::string& base, const std::string& rows) {
  return told_of(base + "\n[[rocks]]\nname = \"table\"\nmaterial = \"basalt\"\ntable = \"rocks.csv\"\n",
                 {{}, "", "", {{"rocks.csv", rows}}});
}
inline std::string with_stl(const std::string& facets, const std::string& key = "file_stl") {
  return told_of(rocks_in_space, {{},
                                  "radius_m = 0.4",
                                  "shape = \"polyhedron\"\n" + key + " = \"rock.stl\"",
                                  {{"rock.stl", "solid rock\n" + facets + "endsolid rock\n"}}});
}
/// The first faces of a pyramid of 0.8 m: two of its base, four of its sides.
inline std::string pyramid(std::size_t faces) {
  const std::string corners[] = {"0 0 0", "0.8 0 0", "0.8 0.8 0", "0 0.8 0", "0.4 0.4 0.8"};
  constexpr int all[][3] = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  std::string text;
  for (std::size_t k = 0; k < faces; ++k) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : all[k]) text += "vertex " + corners[corner] + "\n";
    text += "endloop\nendfacet\n";
  }
  return text;
}

}  // namespace mpm::test
