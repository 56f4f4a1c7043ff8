// States of a test for a page: grains in their cell, their contacts, and fields of the grains.
//
// A state is packed (packed.hpp), little-endian, one array after the other:
//   lattice       9 float32, m, column by column, laboratory frame; the cell's centre is the origin
//   position      d arrays of uint16, one a grain: part of each cell vector times 65536
//   orientation   ellipses: uint16, the angle of the long axis over pi times 65536
//   fields        one array of uint16 each: 0 to 65534 from the field's low to its high, 65535: none
//   i, j          uint16 (uint32 beyond 65536 grains), one a contact
//   image         d arrays of uint8: lattice translation of j + 128, where both grains lie in the cell
//   force         uint16: normal force over the largest of the run times 65534
//   friction      uint8: tangential force over its limit times 255
//   normal        ellipses: uint16, the angle of the normal over 2 pi times 65536
// The error of positions is at most 1/130,000 of the cell, 1/3,000 of a mean diameter in a cell of some twenty.
#pragma once

#include "rvelab/report/test.hpp"

namespace rvelab::report {

/// States of a test in a page: every `every`-th snapshot, the first and the end.
struct ChosenStates {
  std::vector<std::size_t> snapshots;  ///< rows of RecordedTest::snapshots
  bool end = true;                     ///< the end state is not among the snapshots
};
ChosenStates chosen_states(const Test& test, std::size_t every);

/// Bytes of all states of a test before compression.
double bytes_of_states(const Test& test);

/// Data of the states of one test for a page.
Json states_of(const Test& test, const ChosenStates& chosen);

}  // namespace rvelab::report
