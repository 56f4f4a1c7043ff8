// The files of a data sheet.
#pragma once

#include <string>
#include <vector>

#include "rvelab/sheet/sheet.hpp"
#include "tools/models/models.hpp"

namespace rvelab::sheet {

/// Writes index.html, summary.json and summary.csv into the folder.
void write_sheet(const Sheet& sheet, const std::vector<models::Fit>& fits, const std::string& folder);

}  // namespace rvelab::sheet
