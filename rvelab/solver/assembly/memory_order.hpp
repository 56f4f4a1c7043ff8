// The order in which a large assembly keeps its grains: along a space-filling curve, so that neighbours in space are
// neighbours in memory. Outside, grains are always in the order of their ids; the order is part of the state, because
// sums over grains round by it.
//
// `order[row]` is the index into Specimen::grains of the grain in that row; empty: as they stand.
#pragma once

#include <cstdint>
#include <vector>

#include "rvelab/solver/assembly/network.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// Grains from which an assembly is put in order on opening: below, everything stays in the second-level cache.
constexpr std::size_t least_ordered_grains = 2000;

/// Morton order of the positions in units of the lattice vectors, 1024 steps each (2D: 65,536).
std::vector<std::int32_t> space_filling_order(const Cell& cell, const std::vector<Vector3>& positions);

/// Grains, contacts and list positions by row in memory (ids then no longer ascend), and back. A contact whose grains
/// change sides is turned round. An empty order changes nothing.
Specimen in_memory_order(Specimen specimen, const std::vector<std::int32_t>& order);
Specimen in_id_order(Specimen specimen, const std::vector<std::int32_t>& order);
Network in_id_order(Network network, const std::vector<std::int32_t>& order);

}  // namespace rvelab
