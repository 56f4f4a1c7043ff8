// The pages that tools/report makes, as part of this program, and how they are filled.
#pragma once

#include <string>
#include <string_view>

#include "rvelab/report/json.hpp"

namespace rvelab::report {

/// tools/report/page.html, of `rvelab report`.
std::string_view page_template();
/// tools/report/sheet.html, of `rvelab sheet`.
std::string_view sheet_template();

/// A page with its title and its data, so that no tag can begin in them.
std::string filled(std::string_view page, const std::string& title, const Json& data);

}  // namespace rvelab::report
