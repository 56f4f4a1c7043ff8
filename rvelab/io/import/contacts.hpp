// Contacts of an imported packing: their history, and the check that file and parameters belong together.
#pragma once

#include <vector>

#include "rvelab/io/import/csv_table.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// Reads the contacts of a specimen whose grains, cell and parameters stand; `wraps` holds each grain's wrapping
/// translation. Errors as import_csv says.
void read_contacts(const CsvTable& table, const std::vector<Image>& wraps, Specimen& specimen);

/// Of one contact, as the law makes it: branch x_j + L image - x_i (m, cell frame), overlap (m), parameters of the
/// pair, elastic normal force (N, repulsion positive, 0 without overlap).
Vector3 branch_of(const Specimen& specimen, const Contact& contact);
/// Cell frame, from i to j; along the branch where the grains are round.
Vector3 normal_of(const Specimen& specimen, const Contact& contact);
double overlap_of(const Specimen& specimen, const Contact& contact);
PairParameters parameters_of(const Specimen& specimen, const Contact& contact);
double normal_force_of(const Specimen& specimen, const Contact& contact);

/// Sets Contact::last_root_overlap: sqrt(overlap) with laws that store it (hertz_mindlin), else zero.
void set_root_overlaps(Specimen& specimen);

}  // namespace rvelab::io
