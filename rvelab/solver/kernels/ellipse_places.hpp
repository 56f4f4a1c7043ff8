// Where many pairs of ellipses lie, for sums outside the step loops: by the passes of those loops.
#pragma once

#include "rvelab/solver/kernels/ellipses.hpp"

namespace rvelab {
namespace {

/// What PlaceKernel asks for.
template <int W>
void ellipse_pair_places(const StepConstants& c, const PairArrays& p, const double* rows, long begin, long end,
                         double* places) {
  using T = PairTraits<W, false, Slip::consistent, false, false>;
  using V = typename Lanes<W>::V;
  EllipseScratch s;
  for (long first = begin; first < end; first += chunk_pairs) {
    const long count = end - first < chunk_pairs ? end - first : chunk_pairs;
    ellipse_rows<T>(p, rows, first, count, s);
    ellipse_places<T>(c, p, first, count, s);
    for (long k = 0; k < count; k += W) {
      const V near[4] = {load_as<V>(s.nx.at + k), load_as<V>(s.ny.at + k), load_as<V>(s.overlap.at + k),
                         load_as<V>(s.reach_i.at + k)},
              far[4] = {load_as<V>(s.reach_j.at + k), load_as<V>(s.turn_i.at + k), load_as<V>(s.turn_j.at + k), V{}};
      double* const row = places + place_row_length * (first + k);
      rows_of<W>(near, row, place_row_length);
      rows_of<W>(far, row + 4, place_row_length);
    }
  }
}

}  // namespace
}  // namespace rvelab
