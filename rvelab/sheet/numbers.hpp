// The numbers of a data sheet, of the tests that were made.
#pragma once

#include <string>
#include <vector>

#include "rvelab/sheet/sheet.hpp"

namespace rvelab::sheet {

/// Numbers and figures of a soil from its tests; those in the same order give the same bits. A remark for each group
/// that the tests do not give. Definitions and sources: the page "The numbers of a data sheet" of the manual.
Sheet numbers_of(const std::vector<Test>& tests, const std::string& soil);

}  // namespace rvelab::sheet
