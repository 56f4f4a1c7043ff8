// What a shape says of itself, in one file each (disc.hpp, sphere.hpp, ellipse.hpp); all else asks for these properties
// and knows no shape by name. No Eigen and no containers: the step kernels read it.
//
// Of every shape: its name; dimension; `round`: the normal force does not turn the grains and no axis is kept; the
// layout of its grain rows (solver/kernels/configuration.hpp) and where they keep the scaled mass, and 1 over the
// scaled inertia, while the working arrays are released: what stands there otherwise is made again by complete_row;
// `pairs_hold_radii`: its kernels read the radii by pairs; `fills_rows`: equal grains of it, their axes along rows,
// touch in the triangular lattice of discs stretched along them; `has_hertz_curvature`: contact/hertz_curvature.hpp
// holds for it; its inertia, kg m^2. The radius is that of the disc of its area, or of the sphere of its volume.
//
// A shape that is not round adds columns of lengths to those of all grains and says which of them are allowed, what
// radius and outline they make; beside that, solver/assembly/outline.hpp. In the plane it keeps an axis of length 1
// (Grains::orientation), the long one, and says the curvature and which lengths have an aspect ratio. In space it is
// `rigid`: each grain is a body of its own (Specimen::bodies), which has orientation and motion.
#pragma once

namespace rvelab {

/// What one grain holds, where a column stands for many.
template <class T>
using One = T;

/// A column of lengths, or of pure numbers, by its member among the columns of its shape.
template <class Columns, class Entries>
struct OwnColumn {
  const char* dataset;  ///< name in specimen files and XDMF
  const char* csv;      ///< name in CSV tables
  Entries Columns::*entries;
  const char* unit = "m";
};

/// Aspect ratios that contacts of grains which are not round are held to be right for.
inline constexpr double least_aspect_ratio = 0.1;

/// How far an outline comes, m: radii of the circles around and within it; a turn theta moves it by |sin theta|
/// `turning` at most, so that the derivative of its support is no larger.
struct Extent {
  double outer, inner, turning;
};

/// Where an outline touches: second derivative of its support by the direction, m, and d ln of the radius of curvature
/// by a turn of the normal against the grain.
struct Bend {
  double second, flattening;
};

/// Two values that the grain loop of a shape reads, made from the lengths of a grain.
struct TurnValues {
  double first, second;
};

/// Of grains that are round: radius and position say all. `Self`: the shape.
template <class Self>
struct RoundGrain {
  static constexpr bool round = true, rigid = false, has_hertz_curvature = false;
  template <template <class> class Of>
  struct Columns {};
};

}  // namespace rvelab
