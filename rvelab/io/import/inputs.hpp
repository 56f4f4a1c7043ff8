// What import_csv reads: tables (csv_table.hpp), dumps and data files of LAMMPS, META.json, and the contacts of a
// packing.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/io/import/csv.hpp"
#include "rvelab/io/import/csv_table.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// Says something that a user should know, on one line.
using Tell = std::function<void(const std::string&)>;

/// A box of LAMMPS.
struct LammpsBox {
  Matrix3 cell;                           ///< m, vectors as columns; of a general triclinic box in its own frame
  Vector3 low;                            ///< m, its corner
  bool periodic[3] = {true, true, true};  ///< along a, b, c
};

/// The atoms of one timestep of a dump, or of a data file.
struct LammpsAtoms {
  LammpsBox box;
  std::string box_place;  ///< "path:line: what stands there", for messages about the box
  /// Columns as in the file, but xu, xs and xsu are x (m) there; places name the file's lines.
  std::unique_ptr<CsvTable> table;
};

/// Length of a unit of LAMMPS' `units`, in m: si, cgs, micro, nano. InputError by name for the others, which state
/// neither kilograms nor metres, or those of atoms; `location` goes before the message.
double metres_of(const std::string& units, const std::string& location);

/// Whether a text begins as a dump does: with an ITEM.
bool is_lammps_dump(std::string_view text);

/// One timestep of a dump: the last, or the one asked for. Of units si, cgs, micro or nano; without ITEM: UNITS in SI
/// units. InputError naming the line: not a dump of atoms, an item missing or cut, more or fewer rows than ITEM: NUMBER
/// OF ATOMS, a row that is not whole, a last line that is not ended; where frames before it are whole, the last of
/// them is offered.
LammpsAtoms read_lammps_dump(const std::string& path, const Text& text, const std::optional<std::int64_t>& timestep,
                             const Tell& tell);

/// Whether a text has the line "N atoms" of a data file.
bool is_lammps_data(std::string_view text);

/// A data file of atom_style sphere. InputError naming the line: another style, a box or section missing or cut, more
/// or fewer rows than atoms.
LammpsAtoms read_lammps_data(const std::string& path, const Text& text, const Tell& tell);

/// The particles of any file, with the dimension that is meant and the cell that the file states.
struct Particles {
  std::unique_ptr<CsvTable> table;
  int dimension;
  std::optional<Matrix3> cell;  ///< m, vectors as columns; 2D: (2, 2) is the thickness
};

/// Reads a table, a dump or a data file. `stated`: the dimension that META.json says; `options` as of import_csv.
Particles read_particles(const std::string& path, const std::optional<int>& stated, const ImportOptions& options);

/// Contents of META.json. InputError: a missing key that is not optional, one of the wrong kind or out of range.
struct Meta {
  int dimension;
  std::optional<Matrix3> cell;      ///< m, cell vectors as columns, laboratory frame; 2D: (2, 2) is the thickness
  std::optional<double> thickness;  ///< m, 2D
  double reference_pressure;        ///< Pa, 0 if the file has none
  std::optional<std::size_t> particles, contacts;  ///< rows that the tables beside it have
};

/// Reads the file; with `parameters`, sets the material, law and rolling of the specimen from it.
Meta read_meta(const std::string& path, Specimen& specimen, bool parameters);

/// Reads the contacts of a specimen whose grains, cell and parameters stand; `wraps` holds each grain's wrapping
/// translation. Errors as import_csv.
void read_contacts(const CsvTable& table, const std::vector<Image>& wraps, Specimen& specimen);

}  // namespace rvelab::io
