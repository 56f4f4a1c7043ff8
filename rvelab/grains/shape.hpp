// The shapes there are. A new shape is a file of its own, like its neighbours, and a line here. This module knows one
// grain at a time: no contact, no cell.
#pragma once

#include "rvelab/grains/disc.hpp"
#include "rvelab/grains/ellipse.hpp"
#include "rvelab/grains/sphere.hpp"
#include "rvelab/grains/superellipsoid.hpp"

namespace rvelab {

/// Enumerator and description of each, in the order of Shape.
#define RVELAB_SHAPES(each) \
  each(disc, Disc) each(sphere, Sphere) each(ellipse, Ellipse) each(superellipsoid, SuperellipsoidGrain)

#define RVELAB_ENUMERATOR(shape, description) shape,
#define RVELAB_DESCRIBED(shape, description) \
  template <>                                \
  struct Described<Shape::shape> {           \
    using By = description;                  \
  };
#define RVELAB_ONE_MORE(shape, description) +1

/// The shape of all grains of a specimen; it fixes the dimension.
enum class Shape { RVELAB_SHAPES(RVELAB_ENUMERATOR) };
constexpr int shape_count = RVELAB_SHAPES(RVELAB_ONE_MORE);

template <Shape shape>
struct Described;
RVELAB_SHAPES(RVELAB_DESCRIBED)
/// What the shape says of itself (description.hpp).
template <Shape shape>
using Description = typename Described<shape>::By;

#undef RVELAB_ENUMERATOR
#undef RVELAB_DESCRIBED
#undef RVELAB_ONE_MORE

/// A shape as a type, for loops that are compiled for it.
template <Shape shape>
struct ShapeIs {
  static constexpr Shape value = shape;
  using By = Description<shape>;
};
/// call(ShapeIs<...>{}) for the shape of this value.
template <int number = 0, class Call>
static inline __attribute__((always_inline)) constexpr auto with_shape(Shape shape, const Call& call) {
  if constexpr (number + 1 < shape_count) {
    if (shape != Shape(number)) return with_shape<number + 1>(shape, call);
  }
  return call(ShapeIs<Shape(number)>{});
}

#define RVELAB_PROPERTY(type, function, property)                                 \
  constexpr type function(Shape shape) {                                          \
    return with_shape(shape, [](auto is) { return decltype(is)::By::property; }); \
  }
RVELAB_PROPERTY(const char*, name, name)
RVELAB_PROPERTY(int, dimension_of, dimension)
RVELAB_PROPERTY(bool, is_round, round)
RVELAB_PROPERTY(bool, moves_as_body, rigid)
RVELAB_PROPERTY(bool, pairs_hold_radii, pairs_hold_radii)
RVELAB_PROPERTY(bool, fills_rows, fills_rows)
RVELAB_PROPERTY(bool, has_hertz_curvature, has_hertz_curvature)
RVELAB_PROPERTY(int, row_length_of, row_length)
RVELAB_PROPERTY(int, released_mass, released_mass)
RVELAB_PROPERTY(int, released_inverse_inertia, released_inverse_inertia)
#undef RVELAB_PROPERTY

/// Whether each grain has an axis in the plane (Grains::orientation).
constexpr bool keeps_axis(Shape shape) { return !is_round(shape) && !moves_as_body(shape); }

/// The grains of this dimension that are round.
constexpr Shape round_shape(int dimension) {
  int found = 0;
  while (!is_round(Shape(found)) || dimension_of(Shape(found)) != dimension) ++found;
  return Shape(found);
}

/// Solid volume of a grain, m^3. In the plane pi r^2 thickness; sphere: 4/3 pi r^3 (thickness unused).
constexpr double grain_volume(Shape shape, double radius, double thickness) {
  constexpr double pi = 3.14159265358979323846;
  return dimension_of(shape) == 3 ? 4.0 / 3.0 * pi * radius * radius * radius : pi * radius * radius * thickness;
}

/// Cross-section through the centre, m^2, of the disc or sphere of its radius: 2 r thickness; pi r^2.
constexpr double grain_section(Shape shape, double radius, double thickness) {
  return dimension_of(shape) == 3 ? 3.14159265358979323846 * radius * radius : 2 * radius * thickness;
}

}  // namespace rvelab
