// Plates under pressure as tests set them up.
#pragma once

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

}  // namespace mpm::test
