// Measurements of a laboratory, and published numbers, beside those of a sheet.
#pragma once

#include <string>

#include "rvelab/sheet/sheet.hpp"

namespace rvelab::sheet {

/// Adds what a file names: [[number]] a published value of a number, [[measured]] a curve of a test (read as those of a
/// fit are), [[points]] symbols or a line in a figure, in the units of its axes. A remark where the sheet has no such
/// number or figure. InputError with every mistake of the file and its line, or of a curve.
void add_measured(Sheet& sheet, const std::string& toml_path);

}  // namespace rvelab::sheet
