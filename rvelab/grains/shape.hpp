// Grain shapes and their mass properties. This room knows one grain at a time: no contact, no cell.
#pragma once

namespace rvelab {

/// The shape of all grains of a specimen; it fixes the dimension.
enum class Shape { disc, sphere };

constexpr int dimension_of(Shape shape) { return shape == Shape::disc ? 2 : 3; }

/// Solid volume of a grain, m^3. Disc: pi r^2 thickness; sphere: 4/3 pi r^3 (thickness unused).
constexpr double grain_volume(Shape shape, double radius, double thickness) {
  constexpr double pi = 3.14159265358979323846;
  return shape == Shape::disc ? pi * radius * radius * thickness : 4.0 / 3.0 * pi * radius * radius * radius;
}

/// Cross-section through the centre, m^2. Disc: 2 r thickness; sphere: pi r^2 (thickness unused).
constexpr double grain_section(Shape shape, double radius, double thickness) {
  return shape == Shape::disc ? 2 * radius * thickness : 3.14159265358979323846 * radius * radius;
}

/// Moment of inertia about the centre (disc: about its axis), kg m^2.
constexpr double moment_of_inertia(Shape shape, double mass, double radius) {
  return (shape == Shape::disc ? 0.5 : 0.4) * mass * radius * radius;
}

}  // namespace rvelab
