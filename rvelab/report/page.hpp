// The page of `rvelab report`: one HTML file that holds its figures, their numbers and the program that draws them, and
// loads nothing. tools/report has the program; its built form, page.html, is part of this one.
#pragma once

#include <string>
#include <vector>

namespace rvelab::report {

struct PageOptions {
  std::string title;             ///< "": the names of the tests
  double largest_states = 24e6;  ///< bytes that the states of all tests may take before they are compressed
};

struct Page {
  std::string html;
  std::size_t tests = 0, mpm_runs = 0, states = 0;
  std::vector<std::string> remarks;  ///< what the user should know, one line each
};

/// A page of record files, of the record files in folders, and of folders of rvelab-mpm. InputError: a file cannot be
/// read, or a folder holds neither.
Page page_of(const std::vector<std::string>& inputs, const PageOptions& options);

/// Every record file that page_of would read.
std::vector<std::string> files_of(const std::vector<std::string>& inputs);

}  // namespace rvelab::report
