// The state that overlaps, forces and pressures are measured against.
#pragma once

#include "rvelab/specimen/described.hpp"

namespace rvelab {

/// Of the state in which a specimen was first opened, or that was made the reference since.
struct Reference {
  double contact_force = 0;  ///< mean, N; 0: set on opening
  double overlap = 0;        ///< mean, m; 0: set on opening
  double pressure = 0;       ///< p, Pa; 0: set on opening
};

template <>
inline constexpr auto fields::members_of<Reference> = std::tuple{
    Field{"contact_force_N", &Reference::contact_force, "N"},
    Field{"overlap_m", &Reference::overlap, "m"},
    Field{"pressure_Pa", &Reference::pressure, "Pa"},
};

}  // namespace rvelab
