// A specimen as the files that import_csv reads: what users of YADE know, and the way back.
#pragma once

#include <string>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

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
