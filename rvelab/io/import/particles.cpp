// Which kind of file holds the particles, and whether they are discs or spheres. Declared in inputs.hpp.
#include <algorithm>
#include <array>

#include "rvelab/error.hpp"
#include "rvelab/io/import/inputs.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::io {
namespace {

/// Least and largest coordinate along an axis, m.
std::pair<double, double> extent_of(const CsvTable& table, const char* axis) {
  const auto column = table.column({axis});
  double low = table.length(0, column), high = low;
  for (std::size_t row = 1; row < table.rows(); ++row) {
    const double x = table.length(row, column);
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return {low, high};
}

/// The axis along which all centres are the same but for round-off; 0 if there is none.
char flat_axis(const CsvTable& table) {
  if (table.rows() == 0) return 0;
  double lengths[3], longest = 0;
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = extent_of(table, std::array{"x", "y", "z"}[std::size_t(k)]);
    longest = std::max(longest, lengths[k] = high - low);
  }
  // Two centres always have a plane, and one has all of them.
  const bool enough = table.rows() > 2;
  for (const int k : {2, 1, 0}) {
    if (lengths[k] <= 1e-9 * longest && (k == 2 || enough)) return "xyz"[k];
  }
  return 0;
}

std::string dimension_words(int dimension) { return dimension == 2 ? "discs (2D)" : "spheres (3D)"; }

/// The dimension that META.json or the user says, or that the file shows. `lammps`: a dump or data file, where discs
/// have a z too.
int dimension_of(const CsvTable& table, bool lammps, const std::optional<int>& stated, const ImportOptions& options) {
  if (stated && options.dimension && *stated != *options.dimension) {
    throw InputError("--dimension " + std::to_string(*options.dimension) + " and dim = " + std::to_string(*stated) +
                     " of the packing's JSON file differ; allowed: one dimension; leave --dimension out");
  }
  if (stated) return *stated;
  if (!table.has("z") && !options.dimension) return 2;
  if (!table.has("z") || table.rows() == 0) return options.dimension.value_or(3);
  if (options.dimension == 3) return 3;
  const char flat = flat_axis(table);
  if (options.dimension == 2 && flat != 'z') {
    const auto [low, high] = extent_of(table, "z");
    throw InputError(table.path() + ": --dimension 2 wants all centres at one z, and these are from " + exact(low) +
                     " to " + exact(high) + " m; allowed: one z for discs; read them as spheres, or swap the columns");
  }
  if (options.dimension) return 2;
  if (flat == 0) return 3;
  const int taken = lammps && flat == 'z' ? 2 : 3;
  if (taken == 2 || table.rows() > 2) {
    options.tell(table.path() + ": all centres have the same " + flat + "; taken as " + dimension_words(taken) +
                 (taken == 2    ? "; --dimension 3 reads a layer of spheres"
                  : flat == 'z' ? ", a layer; --dimension 2 reads discs"
                                : ", a layer; discs lie in the plane of x and y: swap the columns for them"));
  }
  return taken;
}

/// Boundaries along which the specimen repeats must be periodic; in 2D the cell's third vector is the thickness.
Matrix3 periodic_cell(const LammpsAtoms& atoms, int dimension) {
  const LammpsBox& box = atoms.box;
  for (int k = 0; k < dimension; ++k) {
    if (box.periodic[k]) continue;
    throw InputError(
        atoms.box_place + ": the box is not periodic along " + "abc"[k] + " (" + "xyz"[k] +
        "); allowed: pp pp pp, or of discs pp pp and any along z (--dimension 2); give a periodic packing");
  }
  Matrix3 cell = box.cell;
  if (dimension == 3) return cell;
  if (cell(2, 0) != 0 || cell(2, 1) != 0) {
    throw InputError(atoms.box_place +
                     ": a or b of the box leaves the plane of x and y; allowed for discs: a and b "
                     "with z = 0; turn the packing, or read it by --dimension 3");
  }
  cell(0, 2) = cell(1, 2) = 0;
  return cell;
}

}  // namespace

Particles read_particles(const std::string& path, const std::optional<int>& stated, const ImportOptions& options) {
  auto whole = whole_text(path, "a table, or a dump or data file of LAMMPS");
  const bool dump = is_lammps_dump(whole), data = !dump && is_lammps_data(whole);
  if (options.timestep && !dump) {
    throw InputError(path +
                     ": is no dump of LAMMPS and has no timesteps; allowed: a dump with --timestep; leave it out");
  }
  if (dump || data) {
    const Text text = std::make_shared<const std::string>(std::move(whole));
    auto atoms = dump ? read_lammps_dump(path, text, options.timestep, options.tell)
                      : read_lammps_data(path, text, options.tell);
    const int dimension = dimension_of(*atoms.table, true, stated, options);
    const Matrix3 cell = periodic_cell(atoms, dimension);
    return {std::move(atoms.table), dimension, cell};
  }
  auto table = std::make_unique<CsvTable>(path, std::move(whole));
  if (table->guessed_columns())
    options.tell(path + " has no header: its columns are taken as x, y, z, radius in m, as YADE writes them");
  const int dimension = dimension_of(*table, false, stated, options);
  std::optional<Matrix3> cell;
  if (table->edges()) cell = table->edges()->asDiagonal();
  return {std::move(table), dimension, cell};
}

}  // namespace rvelab::io
