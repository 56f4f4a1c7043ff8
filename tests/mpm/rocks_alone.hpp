// Scenes of rocks without soil.
#pragma once

#include <string>

namespace mpm::test {

/// A scene of rocks alone; D = 2: the plane.
inline std::string rocks_alone(int d, const std::string& rocks) {
  return "[scene]\nname = \"alone\"\ndimension = " + std::to_string(d) +
         "\n[grid]\ncell_m = 0.1\n[time]\nduration_s = 0.5\n[loads]\ngravity_m_s2 = " +
         (d == 2 ? "[0, -10]" : "[0, 0, -10]") +
         "\n[[rock_material]]\nname = \"basalt\"\ndensity_kg_m3 = 2700\nyoung_modulus_Pa = 1e7\n" + rocks;
}

}  // namespace mpm::test
