// tools/report/page.html as part of this program.
#pragma once

#include <string_view>

namespace rvelab::report {

std::string_view page_template();

}  // namespace rvelab::report
