// What other programs are handed: states as they are shown, and the files of each format (csv.cpp, xdmf.cpp,
// lammps.cpp, material_text.cpp).
#pragma once

#include <string>
#include <vector>

#include "rvelab/solver/assembly/network.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// One state for export. Network and specimen are of the same state: grain k of the one is grain k of the other.
struct ExportState {
  long record = 0;    ///< number of the record that it belongs to; the number of records for an end state
  double strain = 0;  ///< driving strain of that record; 0 without records
  Specimen specimen;
  Network network;
};

/// The parallelepiped of the cell vectors, its centre in the origin of the cell frame. Grains are stored in a cuboid of
/// the same volume (rvelab/cell); other programs want them in the parallelepiped.
class Box {
 public:
  /// `lattice`: m, upper triangular, as columns.
  explicit Box(const Matrix3& lattice);
  const Matrix3& lattice() const { return lattice_; }
  Vector3 corner() const { return -0.5 * (lattice_.col(0) + lattice_.col(1) + lattice_.col(2)); }
  /// The image of a point that lies in the box, up to round-off; the point itself if it does.
  Vector3 wrapped(const Vector3& point) const;

 private:
  Matrix3 lattice_, inverse_;
};

/// The same lattice by other vectors: |xy| and |xz| at most Lxx/2, |yz| at most Lyy/2, still upper triangular. (The
/// reduced basis of a 3D cell may lean further in yz than LAMMPS allows.)
Matrix3 within_tilt_limits(const Matrix3& lattice);

/// Mean stress of each grain, Pa, laboratory frame, tension positive: (1/Vg) sum f (x) (x_c - x_g) over its contacts.
/// sum Vg sigma_g / V is the contact stress.
std::vector<Matrix3> grain_stresses(const Network& network);

// Specimens as LAMMPS and OVITO read them: a text dump of one or more states, and a data file of one.
//
// LAMMPS wants cell vectors a = (xx, 0, 0), b = (xy, yy, 0), c = (xz, yz, zz): that is how rvelab keeps them in the
// cell frame, so positions and velocities are those of the cell frame (Cell::rotation turns them to the laboratory).
// The box is the parallelepiped of the vectors with its centre in the origin; its tilts are brought within LAMMPS'
// limits by other vectors of the same lattice, and grains outside it come in by lattice vectors. 2D: z = 0 and the box
// is as thick as the slab.

/// Writes a dump (ITEM: BOX BOUNDS xy xz yz pp pp pp; id type x y z radius vx vy vz), one timestep a state, SI units,
/// every number exact. `type` is the material's number from 1; ids are moved up if the smallest is below 1, which
/// LAMMPS does not allow. Velocities are fluctuations v' in m/s, and 0 for quasi-static states, whose velocities are
/// per sub-step. Errors as publish_text (io/publish.hpp).
void export_lammps_dump(const std::vector<ExportState>& states, const std::string& path);

/// Writes a data file (read_data, atom_style sphere) with density and spin. LAMMPS makes spheres of what it reads: for
/// a mass that is right in 2D use `set` or fix nve/sphere disc as its manual says.
void export_lammps_data(const ExportState& state, const std::string& path);

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

/// The files of one export, all beginning with the same stem.
struct CsvExport {
  std::string particles;  ///< STEM.particles.csv: id, x, y[, z], r, material
  std::string contacts;   ///< STEM.contacts.csv: id1, id2, sx, sy[, sz], fn, fsx, fsy[, fsz], [ft,] kn, ks (Hertz: kno,
                          ///< kso) and, with rolling, [mx, my,] mz, kr
  std::string meta;       ///< STEM.json: cell and stress level; law and parameters, if META.json can say them
  std::string material;   ///< STEM.material.toml: every parameter of materials, contact, damping and solver
};

/// Their names.
CsvExport csv_files(const std::string& stem);

/// Writes the four files, SI units, laboratory frame, every number exact. `import_csv` with all four gives the same
/// cell, grains, contacts and parameters: bit for bit where the frame is not turned (rotation I, 3D), else to
/// round-off; pairs that touch are contacts, with a history or without. What a resting state does not have (velocities,
/// state of the solver, energy balance) is not kept. InputError if a material has no name that a CSV cell can hold, or
/// two have the same.
CsvExport export_csv(const Specimen& specimen, const std::string& stem);

}  // namespace rvelab::io
