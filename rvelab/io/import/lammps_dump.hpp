// Dumps of LAMMPS (and OVITO) as the importer sees them: the cell, and the atoms as a table.
#pragma once

#include <memory>
#include <string>

#include "rvelab/cell/cell.hpp"
#include "rvelab/io/import/csv_table.hpp"

namespace rvelab::io {

/// The last timestep of a dump.
struct LammpsDump {
  int dimension;  ///< 2 if every z is the same, as in a 2D simulation, else 3
  Matrix3 cell;   ///< m, cell vectors as columns, upper triangular; 2D: (2, 2) is the box' thickness
  /// Columns as in ITEM: ATOMS, but xu, xs and xsu are x (m) there, and diameter is radius; places name the dump's
  /// lines.
  std::unique_ptr<CsvTable> atoms;
};

/// Whether a text begins as a dump does.
bool is_lammps_dump(const std::string& text);

/// Takes a dump in SI units apart; `path` serves the messages. InputError naming the line: not a dump, no box, a box
/// that is not periodic.
LammpsDump read_lammps_dump(const std::string& path, const std::string& text);

}  // namespace rvelab::io
