// Specimens from the files of other programs.
//
// Particles: a table (CSV, or YADE's export.text; csv_table.hpp says what else), or a text dump or data file of LAMMPS
// (LIGGGHTS, OVITO), which brings the cell too (type: the number of the material, from 1; matId of YADE: from 0).
// Columns id, x, y[, z] and r, radius or diameter (m), or in the plane, of ellipses, the semi-axes a >= b (m) and
// `angle` from x to the long one (degrees); of other shapes their own columns; optionally `material`, its name. Without
// id, grains are numbered from 1 in the order of the rows. All may be packed by gzip. Contacts: id1, id2, sx, sy[, sz]
// (lattice shift of the second grain), fn and fsx, fsy[, fsz] (N, force on id2, tangential; in 2D also ft, its
// component along (-n_y, n_x), which goes before them), mz (rolling moment on id2, N m; in 3D mx, my, mz), and the
// stiffnesses kn or kno, ks or kso, kr, which are checked if they are there. Columns are found by their names, others
// are ignored; the state is at rest. META.json: dim, E_Pa, kt_over_kn (linear law) or nu (hertz_mindlin), phi_deg or
// mu, beta, eta, density, hSize or hSize_columns_are_cell_vectors (m), thickness_m (2D), p0_Pa.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// What the files themselves do not say.
struct ImportOptions {
  std::optional<Vector3> cell;               ///< Lxx, Lyy, Lzz of a rectangular cell, m; 2D: Lzz is the thickness
  std::optional<std::string> material_path;  ///< TOML, see read_material_file; replaces the parameters of META.json
  std::vector<std::string> settings;         ///< "contact.slip=consistent"; applied last, kept in the specimen
  std::optional<std::int64_t> timestep;      ///< of a dump; none: its last
  /// 2 or 3; none: META.json's, else 2 where there is no z, or where all atoms of a dump or data file have the same z
  /// (LAMMPS writes discs so), else 3.
  std::optional<int> dimension;
  std::function<void(const std::string&)> tell = [](const std::string&) {};  ///< choices that were made, a line each
};

/// Reads a specimen. Grains are sorted by id, which they keep, and wrapped into the primary cuboid; a cell that is not
/// upper triangular is turned into its frame (Cell::rotation takes it back). Contacts get i <= j, in the order of
/// (i, j, image), with force and moment those on j. The normal force of the file must be that of the law within 1e-6 of
/// the largest, and its stiffnesses the law's within 1e-6: otherwise the file is of other parameters than those given.
/// Throws InputError for the first mistake, naming file, line, column, value and remedy.
Specimen import_csv(const std::string& particles_path, const std::optional<std::string>& contacts_path,
                    const std::optional<std::string>& meta_json_path, const ImportOptions& options = {});

}  // namespace rvelab::io
