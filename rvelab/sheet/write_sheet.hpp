// A data sheet as files: the page index.html, summary.json and summary.csv.
#pragma once

#include <string>
#include <vector>

#include "rvelab/sheet/sheet.hpp"
#include "tools/models/models.hpp"

namespace rvelab::sheet {

/// Makes the folder if it is not there, and writes each file completely or not at all, the page last. `fits`: of
/// models, drawn over the curves of the sheet with the names of their tests. InputError: the folder cannot be written.
void write_sheet(const Sheet& sheet, const std::vector<models::Fit>& fits, const std::string& folder);

/// The same as texts.
std::string page_of_sheet(const Sheet& sheet, const std::vector<models::Fit>& fits);
std::string json_of_sheet(const Sheet& sheet, const std::vector<models::Fit>& fits);
std::string csv_of_sheet(const Sheet& sheet);

}  // namespace rvelab::sheet
