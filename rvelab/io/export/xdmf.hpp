// States as ParaView reads them: an XDMF file, and beside it an HDF5 file with the arrays.
#pragma once

#include <string>
#include <vector>

#include "rvelab/io/export/state.hpp"

namespace rvelab::io {

/// Writes `path` and, beside it, `path`.h5, which the XDMF names relatively: move them together. Laboratory frame, SI
/// units. A time series whose time is the strain of the record, or its number where the strain falls between two states
/// (cycles, several stages); in each state the blocks
///   grains    points in the parallelepiped of the cell vectors: radius_m, id, material, fluctuation velocity and spin
///             (0 for quasi-static states, whose velocities are per sub-step), stress_Pa (mean over the grain),
///             contacts
///   contacts  lines from centre i to that image of centre j which it touches: force_N on j, normal_force_N,
///             overlap_m, sliding (|f_t| at the Coulomb limit); left out of a state that has none
///   cell      the twelve edges of that parallelepiped; 2D: the four of the mid-plane
/// Discs and spheres carry no orientation. Errors as publish() (io/hdf5/file.hpp).
void export_xdmf(const std::vector<ExportState>& states, const std::string& path);

}  // namespace rvelab::io
