// The columns that shapes add to those of all grains (description.hpp), all of them in one struct, and loops over them.
#pragma once

#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "rvelab/grains/shape.hpp"

namespace rvelab {

template <template <class> class Of, class Numbers>
struct ColumnsOfShapes;
template <template <class> class Of, int... number>
struct ColumnsOfShapes<Of, std::integer_sequence<int, number...>>
    : Description<Shape(number)>::template Columns<Of>... {};
/// Of all shapes; those of others than the specimen's are empty. `Of`: what holds the entries.
template <template <class> class Of>
using OwnColumns = ColumnsOfShapes<Of, std::make_integer_sequence<int, shape_count>>;
/// Of one grain.
using OwnValues = OwnColumns<One>;

template <class T>
using List = std::vector<T>;

namespace own_columns {
template <class By, template <class> class Of, class Numbers>
constexpr const auto& described(const ColumnsOfShapes<Of, Numbers>&) {
  return By::template columns<Of>;
}
template <class By>
constexpr const auto& described(const typename By::Own&) {
  return By::template columns<One>;
}
}  // namespace own_columns

/// call(description, entries...) for each column of a shape, with its entries in each of the owners.
template <class By, class Call, class... Owners>
void each_column_of(const Call& call, Owners&... owners) {
  if constexpr (!By::round) {
    for (std::size_t k = 0; k < std::size(By::template columns<One>); ++k)
      call(By::template columns<One>[k], owners.*(own_columns::described<By>(owners)[k].entries)...);
  }
}
/// The same for the columns of all shapes.
template <class Call, class... Owners>
void each_own_column(const Call& call, Owners&... owners) {
  [&]<int... number>(std::integer_sequence<int, number...>) {
    (each_column_of<Description<Shape(number)>>(call, owners...), ...);
  }
  (std::make_integer_sequence<int, shape_count>());
}

/// The lengths of grain g of this shape.
template <class By, class Columns>
OwnValues own_of(const Columns& columns, std::size_t g) {
  OwnValues own;
  each_column_of<By>([g](const auto&, double& value, const auto& column) { value = column[g]; }, own, columns);
  return own;
}
template <class Columns>
OwnValues own_of(Shape shape, const Columns& columns, std::size_t g) {
  return with_shape(shape, [&](auto is) { return own_of<typename decltype(is)::By>(columns, g); });
}

/// About the centre, in the plane about the axis through it, kg m^2.
inline double moment_of_inertia(Shape shape, double mass, double radius, const OwnValues& own = {}) {
  return with_shape(shape, [&](auto is) { return decltype(is)::By::inertia(mass, radius, own); });
}

/// How far its outline comes.
template <class Columns>
Extent extent_of(Shape shape, double radius, const Columns& columns, std::size_t g) {
  return with_shape(shape, [&](auto is) -> Extent {
    using By = typename decltype(is)::By;
    if constexpr (By::round)
      return {radius, radius, 0};
    else
      return By::extent(own_of<By>(columns, g));
  });
}

/// Radii of the circles (spheres) around the grains, m.
template <class Grains>
std::vector<double> reach_of(Shape shape, const Grains& grains) {
  std::vector<double> reach = grains.radius;
  for (std::size_t g = 0; g < reach.size(); ++g) reach[g] = extent_of(shape, reach[g], grains, g).outer;
  return reach;
}

/// The names of the shapes for which this holds, "disc, ellipse"; `plural`: each with an s.
template <class Holds>
std::string names_of_shapes(const Holds& holds, bool plural = false) {
  std::string names;
  for (int number = 0; number < shape_count; ++number)
    if (holds(Shape(number)))
      names += (names.empty() ? "" : ", ") + std::string(name(Shape(number))) + (plural ? "s" : "");
  return names;
}

}  // namespace rvelab
