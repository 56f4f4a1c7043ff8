// Plates under pressure as tests set them up.
#pragma once

#include <string>

#include "tests/mpm/rocks.hpp"

namespace mpm::test {

/// Across an axis at a height along it, over the soil; `area`: m^2, constant.
template <int D>
Body<D> plate_over(int axis, double height, double pressure, double mass, double area) {
  Body<D> body;
  body.shape = HalfSpace<D>{-Vec<D>::Unit(axis)};
  body.centre = height * Vec<D>::Unit(axis);
  body.rough = false;
  body.at_surface = true;
  body.plate.emplace();
  body.plate->mass = mass;
  body.plate->pressure = {{0}, {pressure}};
  body.plate->area = area;
  return body;
}

/// A block of soil in the plane under a plate, between rollers.
inline const std::string pressed_block = R"(
[scene]
name = "pressed"
thickness_m = 2
[grid]
cell_m = 0.1
[time]
duration_s = 0.01
[[material]]
name = "soil"
kind = "elastic"
density_kg_m3 = 2000
young_modulus_Pa = 1e7
[[region]]
material = "soil"
lower_m = [0, 0]
upper_m = [0.4, 0.3]
[[boundary]]
name = "left"
kind = "roller"
axis = "x"
at_m = 0
[[boundary]]
name = "right"
kind = "roller"
axis = "x"
at_m = 0.4
soil = "below"
[[boundary]]
name = "bottom"
kind = "roller"
axis = "y"
at_m = 0
[[body]]
name = "lid"
kind = "half_space"
centre_m = [0, 0.3]
normal = [0, -1]
pressure_Pa = 1e4
)";

}  // namespace mpm::test
