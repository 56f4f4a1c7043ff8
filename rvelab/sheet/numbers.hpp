// The numbers of a data sheet, read off its tests.
#pragma once

#include <string>
#include <vector>

#include "rvelab/sheet/sheet.hpp"

namespace rvelab::sheet {

/// Numbers and figures of the tests. `soil`: name of the recipe.
Sheet numbers_of(const std::vector<Test>& tests, const std::string& soil);

}  // namespace rvelab::sheet
