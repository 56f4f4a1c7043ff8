// Cycles of a cyclic test at constant volume until its pore pressure, or its strain, is there.
//
// At constant volume there is no pore pressure; the one of a laboratory test, whose total stress on the side (sample in
// a cell) or on the plane (simple shear) stays, is what the effective stress there has lost:
//   r_u = 1 - sigma'/sigma'_0     sigma': mean lateral stress of a compression, normal stress of the plane of shear
// Cycles are counted as those of a sine from 0: the first turn is at 1/4, each further one 1/2 later; between turns by
// the driving stress over its amplitude, of a strain-controlled test by the strain over its.
#pragma once

#include <span>

#include "rvelab/protocol/stages.hpp"
#include "rvelab/records/record.hpp"

namespace rvelab::ensemble {

/// Of the first record at which it is there; NaN: it is not within the test.
struct CyclesTo {
  double pore_pressure;  ///< r_u = 0.95
  double strain;         ///< 2.5 % single amplitude; NaN where the strain is controlled
};

/// `axis`: "x", "y", "z" of a compression, "xy" and so on of simple shear.
CyclesTo cycles_to(std::span<const records::Record> stage, const std::string& axis, const protocol::Cycles& cycles,
                   double to_strain, int dimension);

}  // namespace rvelab::ensemble
