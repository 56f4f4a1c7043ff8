#include "rvelab/report/template.hpp"

#include "rvelab/error.hpp"

// The pages are part of the program, so that no separate file is needed. RVELAB_REPORT_PAGE and RVELAB_SHEET_PAGE are
// the paths of the files.
asm(".section .rodata\n"
    ".global rvelab_report_page_begin\n"
    "rvelab_report_page_begin:\n"
    ".incbin \"" RVELAB_REPORT_PAGE
    "\"\n"
    ".global rvelab_report_page_end\n"
    "rvelab_report_page_end:\n"
    ".global rvelab_sheet_page_begin\n"
    "rvelab_sheet_page_begin:\n"
    ".incbin \"" RVELAB_SHEET_PAGE
    "\"\n"
    ".global rvelab_sheet_page_end\n"
    "rvelab_sheet_page_end:\n"
    ".previous\n");
extern "C" const char rvelab_report_page_begin[], rvelab_report_page_end[], rvelab_sheet_page_begin[],
    rvelab_sheet_page_end[];

namespace rvelab::report {
namespace {

/// Text of HTML, also within a script: escaped so that no tag can begin in it.
std::string without_tags(std::string text) {
  std::string safe;
  for (const char letter : text) safe += letter == '<' ? std::string("\\u003c") : std::string(1, letter);
  return safe;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text)
    safe += letter == '<' ? std::string("&lt;") : letter == '&' ? std::string("&amp;") : std::string(1, letter);
  return safe;
}

void put(std::string& html, const std::string& mark, const std::string& text) {
  const auto at = html.find(mark);
  if (at == std::string::npos) throw Error("the page in this program has no " + mark + "; build tools/report again");
  html.replace(at, mark.size(), text);
}

}  // namespace

std::string_view page_template() {
  return {rvelab_report_page_begin, std::size_t(rvelab_report_page_end - rvelab_report_page_begin)};
}

std::string_view sheet_template() {
  return {rvelab_sheet_page_begin, std::size_t(rvelab_sheet_page_end - rvelab_sheet_page_begin)};
}

std::string filled(std::string_view page, const std::string& title, const Json& data) {
  std::string html(page);
  put(html, "<!--title-->", escaped(title));
  put(html, "<!--data-->",
      "<script type=\"application/json\" id=\"data\">" +
          without_tags(data.dump(-1, ' ', false, Json::error_handler_t::replace)) + "</script>");
  return html;
}

}  // namespace rvelab::report
