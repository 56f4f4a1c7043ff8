// The page of `rvelab report`: one HTML file with its figures, their numbers and the script that draws them, which
// loads nothing. The script is in tools/report; its built form, page.html, is part of this program.
#pragma once

#include <string>
#include <vector>

namespace rvelab::report {

struct PageOptions {
  std::string title;             ///< "": the names of the tests
  double largest_states = 24e6;  ///< limit of the bytes of the states of all tests before compression
};

struct Page {
  std::string html;
  std::size_t tests = 0, mpm_runs = 0, states = 0;
  std::vector<std::string> remarks;  ///< remarks for the user, one line each
};

/// A page of record files, of the record files in folders, and of folders of rvelab-mpm. InputError: a file cannot be
/// read, or a folder contains none of them.
Page page_of(const std::vector<std::string>& inputs, const PageOptions& options);

/// Every record file that page_of would read.
std::vector<std::string> files_of(const std::vector<std::string>& inputs);

}  // namespace rvelab::report
