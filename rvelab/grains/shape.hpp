// Grain shapes and their mass properties. This room knows one grain at a time: no contact, no cell.
#pragma once

namespace rvelab {

/// The shape of all grains of a specimen; it fixes the dimension.
enum class Shape { disc, sphere, ellipse };

constexpr int dimension_of(Shape shape) { return shape == Shape::sphere ? 3 : 2; }

/// Solid volume of a grain, m^3. Disc: pi r^2 thickness; sphere: 4/3 pi r^3 (thickness unused). The radius of an
/// ellipse is that of the disc of its area, sqrt(a b).
constexpr double grain_volume(Shape shape, double radius, double thickness) {
  constexpr double pi = 3.14159265358979323846;
  return shape == Shape::sphere ? 4.0 / 3.0 * pi * radius * radius * radius : pi * radius * radius * thickness;
}

/// Cross-section through the centre, m^2. Disc, and ellipse as the disc of its area: 2 r thickness; sphere: pi r^2.
constexpr double grain_section(Shape shape, double radius, double thickness) {
  return shape == Shape::sphere ? 3.14159265358979323846 * radius * radius : 2 * radius * thickness;
}

/// Moment of inertia about the centre (disc: about its axis), kg m^2.
constexpr double moment_of_inertia(Shape shape, double mass, double radius) {
  return (shape == Shape::disc ? 0.5 : 0.4) * mass * radius * radius;
}
/// Of an ellipse of semi-axes a and b (m) about the axis through its centre, kg m^2.
constexpr double ellipse_inertia(double mass, double a, double b) { return 0.25 * mass * (a * a + b * b); }

/// Aspect ratios b/a that contacts of ellipses are held to be right for.
inline constexpr double least_aspect_ratio = 0.1;

}  // namespace rvelab
