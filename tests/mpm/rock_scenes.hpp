// Small scenes with rocks and soil.
#pragma once

#include "tests/mpm/scenes.hpp"

namespace mpm::test {

inline const std::string rocks_in_plane =
    head("plane", "0.25", "1") + soil_of("soil", "elastic", "1500", "1e6") + basalt() +
    region("soil", "[0, 0]", "[4, 1]") + boundary("left", "roller", "x", "0") + box_body("beam", "[3, 3]", "[1, 0.5]") +
    rock("disc", "[1, 1.5]", "radius_m = 0.4\n") +
    rock("slab", "[2.5, 1.5]", "shape = \"superquadric\"\nhalf_axes_m = [0.5, 0.3]\nblockiness = [4]\n") +
    rocks("coarse", "lower_m = [0, 4]\nupper_m = [4, 8]\nvolume_share = 0.2\ndiameters_m = [[0.8, 1]]\n") +
    "[rock_soil]\nfriction = 0.5\n";
inline const std::string rocks_in_space = head("space", "0.25", "1", 3) + soil_of("soil", "elastic", "1500", "1e6") +
                                          basalt() + region("soil", "[0, 0, 0]", "[1, 1, 0.5]") +
                                          rock("ball", "[0.5, 0.5, 1]", "radius_m = 0.4\n");

inline std::string with_table(const std::string& base, const std::string& rows) {
  return outcome(base + rocks("table", "table = \"rocks.csv\"\n"), {{}, "", "", {{"rocks.csv", rows}}});
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
/// The ball in space becomes a polyhedron of these facets.
inline Change with_stl(const std::string& facets, const std::string& key = "file_stl") {
  return {{},
          "radius_m = 0.4",
          "shape = \"polyhedron\"\n" + key + " = \"rock.stl\"",
          {{"rock.stl", "solid rock\n" + facets + "endsolid rock\n"}}};
}

}  // namespace mpm::test
