// Contacts of an imported packing: their history, and the check that file and parameters belong together.
#pragma once

#include <vector>

#include "rvelab/io/import/csv_table.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// Reads the contacts of a specimen whose grains, cell and parameters stand; `wraps` holds each grain's wrapping
/// translation. Errors as import_csv.
void read_contacts(const CsvTable& table, const std::vector<Image>& wraps, Specimen& specimen);

}  // namespace rvelab::io
