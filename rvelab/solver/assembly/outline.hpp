// What the assembly asks of a shape that is not round: its rows, and how two of its grains lie to each other. SHAPE's
// answers are in SHAPE_outline.cpp.
#pragma once

#include <type_traits>

#include "rvelab/grains/own_columns.hpp"
#include "rvelab/solver/assembly/pair_place.hpp"

namespace rvelab {

template <Shape shape>
using PlaceOf = std::conditional_t<moves_as_body(shape), SolidPlace, OutlinePlace>;

template <Shape shape>
struct Outline {
  using Place = PlaceOf<shape>;
  using Own = typename Description<shape>::template Columns<One>;
  /// In the plane. Puts into a row what follows from the lengths and the axis that stands there
  /// (kernels/configuration.hpp).
  static void complete_row(const Own& own, double* row);
  /// From the branch (m) and the rows of the two grains: in the plane what the step kernels find, bit for bit; in space
  /// an overlap within rounding of theirs.
  static Place place(const Branch& branch, const double* row_i, const double* row_j);
  /// Of a pair that is apart (overlap < 0): by the direction of the distance, not just one that shows it.
  static Place nearest_place(const Place& apart, const double* row_i, const double* row_j);
  /// Whether the distance is above `skin`, m.
  static bool farther_apart_than(double skin, const Branch& branch, const double* row_i, const double* row_j);
};

#define RVELAB_DECLARE(shape, description)                                                                \
  template <>                                                                                             \
  void Outline<Shape::shape>::complete_row(const Own&, double*);                                          \
  template <>                                                                                             \
  PlaceOf<Shape::shape> Outline<Shape::shape>::place(const Branch&, const double*, const double*);        \
  template <>                                                                                             \
  PlaceOf<Shape::shape> Outline<Shape::shape>::nearest_place(const Place&, const double*, const double*); \
  template <>                                                                                             \
  bool Outline<Shape::shape>::farther_apart_than(double, const Branch&, const double*, const double*);
RVELAB_SHAPES(RVELAB_DECLARE)
#undef RVELAB_DECLARE

/// The row of a grain of these lengths and this axis, from its axis on: for grains that are in no assembly.
template <Shape shape>
struct LoneRow {
  double row[Description<shape>::row_length] = {};
  LoneRow(const typename Outline<shape>::Own& own, double axis_x, double axis_y) {
    row[5] = axis_x;
    row[6] = axis_y;
    Outline<shape>::complete_row(own, row);
  }
};

}  // namespace rvelab
