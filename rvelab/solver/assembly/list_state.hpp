// What a neighbour list was built on, by which it is judged whether it still holds every pair that may touch.
#pragma once

#include "rvelab/specimen/described.hpp"

namespace rvelab {

struct ListState {
  bool built = false;                 ///< the next five say of what; false: the specimen was never opened
  Matrix3 lattice = Matrix3::Zero();  ///< then, m
  /// Positions then, m, cell frame; empty: only `travel` is used. Of grains that are not round z says how the long axis
  /// lay (oriented_bounds.hpp).
  std::vector<Vector3> positions;
  /// Of bodies of one grain: the vector part, with a scalar part that is not negative, of their orientation then.
  std::vector<Vector3> orientations;
  double travel = 0;         ///< bound on the largest displacement since then beside the cell's, m
  double skin = 0;           ///< m; 0: that of the solver's options
  std::int64_t steps = 0;    ///< sub-steps made since then
  std::uint64_t builds = 0;  ///< lists built so far
};

template <>
inline constexpr auto fields::members_of<ListState> = std::tuple{
    Field{"built", &ListState::built, "1"},
    Field{"lattice_m", &ListState::lattice, "m"},
    Field{"positions_m", &ListState::positions, "m", Rows::per_grain_or_none},
    Field{"orientations", &ListState::orientations, "1", Rows::per_grain_or_left_out},
    Field{"travel_m", &ListState::travel, "m"}.within(number_from_zero),
    Field{"skin_m", &ListState::skin, "m"}.within(number_from_zero),
    Field{"steps", &ListState::steps, "1"}.within(number_from_zero),
    Field{"builds", &ListState::builds, "1"},
};

}  // namespace rvelab
