// Specimens as LAMMPS and OVITO read them: a text dump of one or more states, and a data file of one.
//
// LAMMPS wants cell vectors a = (xx, 0, 0), b = (xy, yy, 0), c = (xz, yz, zz): that is how rvelab keeps them in the
// cell frame, so positions and velocities are those of the cell frame (Cell::rotation turns them to the laboratory).
// The box is the parallelepiped of the vectors with its centre in the origin; its tilts are brought within LAMMPS'
// limits by other vectors of the same lattice, and grains outside it come in by lattice vectors. 2D: z = 0 and the box
// is as thick as the slab.
#pragma once

#include <string>
#include <vector>

#include "rvelab/io/export/state.hpp"

namespace rvelab::io {

/// Writes a dump (ITEM: BOX BOUNDS xy xz yz pp pp pp; id type x y z radius vx vy vz), one timestep a state, SI units,
/// every number exact. `type` is the material's number from 1; ids are moved up if the smallest is below 1, which
/// LAMMPS does not allow. Velocities are fluctuations v' in m/s, and 0 for quasi-static states, whose velocities are
/// per sub-step. Errors as publish_text (text_file.hpp).
void export_lammps_dump(const std::vector<ExportState>& states, const std::string& path);

/// Writes a data file (read_data, atom_style sphere) with density and spin. LAMMPS makes spheres of what it reads: for
/// a mass that is right in 2D use `set` or fix nve/sphere disc as its manual says.
void export_lammps_data(const ExportState& state, const std::string& path);

}  // namespace rvelab::io
