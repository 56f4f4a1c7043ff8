#include "rvelab/report/template.hpp"

// The page is part of the program, so that no separate file is needed. RVELAB_REPORT_PAGE is the path of the file.
asm(".section .rodata\n"
    ".global rvelab_report_page_begin\n"
    "rvelab_report_page_begin:\n"
    ".incbin \"" RVELAB_REPORT_PAGE
    "\"\n"
    ".global rvelab_report_page_end\n"
    "rvelab_report_page_end:\n"
    ".previous\n");
extern "C" const char rvelab_report_page_begin[], rvelab_report_page_end[];

namespace rvelab::report {

std::string_view page_template() {
  return {rvelab_report_page_begin, std::size_t(rvelab_report_page_end - rvelab_report_page_begin)};
}

}  // namespace rvelab::report
