// Plates under pressure as tests set them up.
#pragma once

#include "tests/mpm/rocks.hpp"
#include "tests/mpm/scenes.hpp"

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
inline const std::string pressed_block =
    head("pressed", "0.1", "0.01", 2, "thickness_m = 2\n") + soil_of("soil", "elastic", "2000", "1e7") +
    region("soil", "[0, 0]", "[0.4, 0.3]") + boundary("left", "roller", "x", "0") +
    boundary("right", "roller", "x", "0.4", below) + boundary("bottom", "roller", "y", "0") +
    half_space("lid", "[0, 0.3]", "[0, -1]", "pressure_Pa = 1e4\n");

}  // namespace mpm::test
