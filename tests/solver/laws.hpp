// Specimens of the laws and of every shape.
#pragma once

#include <vector>

#include "tests/specimens.hpp"

namespace rvelab::test {

inline Material hertz_material() {
  Material m;
  m.young_modulus = 1e9;
  m.poisson_ratio = 0.3;
  m.roughness = 1e-5;
  m.cone_slope = 0.05;
  m.friction = 0.5;
  return m;
}

inline std::vector<Specimen> disordered_of_each_law() {
  return {disordered(Shape::disc, 9, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.52, 3),
          disordered(Shape::disc, 9, hertz_material(), Law::hertz_mindlin, 0.51, 6),
          disordered(Shape::ellipse, 9, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.52, 3),
          disordered(Shape::sphere, 5, hertz_material(), Law::hertz_mindlin, 0.51, 4),
          disordered(Shape::sphere, 5, linear_material(2e6, 5e5, 0.4), Law::linear_stiffness, 0.52, 8),
          disordered(Shape::sphere, 5, hertz_material(), Law::hertz_rough, 0.51, 4),
          disordered(Shape::disc, 9, hertz_material(), Law::cones, 0.51, 6)};
}

}  // namespace rvelab::test
