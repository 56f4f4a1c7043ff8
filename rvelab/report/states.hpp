// States of a test as a page draws them: grains in their cell, their contacts, and what each grain bears and does.
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
// Positions are so exact to 1/130,000 of the cell, the 3,000th part of a mean diameter in a cell of twenty-odd.
#pragma once

#include "rvelab/report/test.hpp"

namespace rvelab::report {

/// States of a test that are kept in a page: all `every`-th snapshots, the first and the end.
struct ChosenStates {
  std::vector<std::size_t> snapshots;  ///< rows of RecordedTest::snapshots
  bool end = true;                     ///< the end state is none of the snapshots
};
ChosenStates chosen_states(const Test& test, std::size_t every);

/// Bytes that the states of a test take before they are compressed, all of them.
double bytes_of_states(const Test& test);

/// What a page is told of the states of one test.
Json states_of(const Test& test, const ChosenStates& chosen);

}  // namespace rvelab::report
