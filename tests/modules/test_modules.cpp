// The modules are used in the order that rvelab/README.md and tools/mpm/README.md print: every include is held against
// the tables there.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/catch.hpp"

namespace {

const std::filesystem::path root = RVELAB_SOURCE_DIR;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream input(path);
  return {std::istreambuf_iterator<char>(input), {}};
}

/// First cells of the table below "## Modules" that name code, in their order: files and folders from the root on.
std::vector<std::string> order_in(const std::string& readme) {
  std::vector<std::string> modules;
  std::istringstream lines(readme);
  bool below = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) below = line == "## Modules";
    const bool row =
        line.starts_with("| rvelab/") || line.starts_with("| tools/mpm/") || line.starts_with("| tools/models |");
    if (below && row) modules.push_back(line.substr(2, line.find(" |", 2) - 2));
  }
  return modules;
}

/// Row that a file belongs to: the longest name that is the file or a folder above it; the number of rows: none.
std::size_t row_of(const std::vector<std::string>& order, const std::string& file) {
  std::size_t found = order.size(), longest = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool holds = file == order[k] || file.starts_with(order[k] + "/");
    if (holds && order[k].size() > longest) {
      found = k;
      longest = order[k].size();
    }
  }
  return found;
}

bool against_order(const std::vector<std::string>& order, const std::string& file, const std::string& included) {
  const std::size_t to = row_of(order, included);
  return to == order.size() || to > row_of(order, file);
}

/// Sources and headers under a folder, from the root on, in the order of their names.
std::vector<std::string> code_under(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
    const auto extension = entry.path().extension();
    if (extension != ".cpp" && extension != ".hpp") continue;
    files.push_back(std::filesystem::relative(entry.path(), root).generic_string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Of the two programs whose modules are listed.
const std::vector<std::string> in_modules = {"rvelab", "tools/mpm"};
std::vector<std::string> code_in_modules() {
  std::vector<std::string> files;
  for (const std::string& folder : in_modules) {
    const auto more = code_under(folder);
    files.insert(files.end(), more.begin(), more.end());
  }
  return files;
}

/// What a file includes, in quotation marks or (`open` = '<') in angle brackets.
std::vector<std::string> includes_of(const std::string& file, char open = '"') {
  std::vector<std::string> found;
  std::istringstream lines(text_of(root / file));
  const char close = open == '<' ? '>' : open;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("#")) continue;
    const auto begin = line.find(open), word = line.find("include");
    if (word == std::string::npos || begin == std::string::npos || begin < word) continue;
    found.push_back(line.substr(begin + 1, line.find(close, begin + 1) - begin - 1));
  }
  return found;
}

}  // namespace

TEST_CASE("an include against the order is seen, in a folder within a module too") {
  const auto order = order_in(
      "# p\n| rvelab/before | |\n## Modules\n\n| folder | what |\n| --- | --- |\n| rvelab/error.hpp | a |\n"
      "| rvelab/cell | b |\n| rvelab/solver/kernels | c |\n| rvelab/solver | d |\n| tests | e |\n## Limits\n| rvelab/x "
      "| |\n");
  REQUIRE(order ==
          std::vector<std::string>{"rvelab/error.hpp", "rvelab/cell", "rvelab/solver/kernels", "rvelab/solver"});
  CHECK(!against_order(order, "rvelab/cell/cell.hpp", "rvelab/error.hpp"));
  CHECK(!against_order(order, "rvelab/cell/cell.cpp", "rvelab/cell/givens.hpp"));
  CHECK(!against_order(order, "rvelab/solver/rve.cpp", "rvelab/solver/kernels/discs.hpp"));
  CHECK(!against_order(order, "rvelab/solver/loading/servo.cpp", "rvelab/solver/rve.hpp"));  // a folder without a row
  CHECK(against_order(order, "rvelab/solver/kernels/discs.hpp", "rvelab/solver/rve.hpp"));
  CHECK(against_order(order, "rvelab/error.hpp", "rvelab/cell/cell.hpp"));
  CHECK(against_order(order, "rvelab/cell/cell.hpp", "rvelab/solver/rve.hpp"));
  CHECK(against_order(order, "rvelab/solver/rve.hpp", "rvelab/cellar/wine.hpp"));  // of no module
}

TEST_CASE("each module includes only those above it in the list of its README") {
  for (const std::string& folder : in_modules) {
    CAPTURE(folder);
    const auto order = order_in(text_of(root / folder / "README.md"));
    REQUIRE(order.size() > 10);
    CHECK(std::set(order.begin(), order.end()).size() == order.size());
    for (const std::string& module : order) {
      CAPTURE(module);
      CHECK(std::filesystem::exists(root / module));
    }
    std::size_t includes = 0;
    for (const std::string& file : code_under(folder)) {
      if (row_of(order, file) == order.size()) FAIL_CHECK(file << " is in no module of " << folder << "/README.md");
      for (const std::string& included : includes_of(file)) {
        ++includes;
        if (against_order(order, file, included))
          FAIL_CHECK(file << " includes " << included << ", which is not above it");
      }
    }
    CHECK(includes > 200);
  }
  // Water and rocks do not know each other, whichever stands first: the step brings them together.
  for (const std::string& file : code_under("tools/mpm/water")) {
    for (const std::string& included : includes_of(file))
      if (included.starts_with("tools/mpm/rocks/")) FAIL_CHECK(file << " includes " << included);
  }
}

TEST_CASE("no header includes itself by way of others") {
  std::map<std::string, bool> done;  // false: under way
  const auto visit = [&](const auto& self, const std::string& file, const std::string& from) -> void {
    const auto [entry, first] = done.emplace(file, false);
    if (!first && !entry->second) FAIL_CHECK(from << " includes " << file << ", which leads back to it");
    if (!first) return;
    for (const std::string& included : includes_of(file)) self(self, included, file);
    done[file] = true;
  };
  for (const std::string& file : code_in_modules()) visit(visit, file, "");
  CHECK(done.size() > 200);
}

TEST_CASE("no two types of one namespace have one name") {
  // Two would be one type to the linker, with the layout of either.
  std::map<std::string, std::string> found;
  std::size_t types = 0;
  for (const std::string& file : code_in_modules()) {
    std::vector<std::string> spaces;  // of the blocks that begin at the first letter of a line, and are open
    std::istringstream lines(text_of(root / file));
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string what, name;
      words >> what;
      if (line.starts_with("}  // namespace") && !spaces.empty()) spaces.pop_back();
      if (line.starts_with("namespace ") && line.ends_with("{")) {
        words >> name;
        spaces.push_back(name == "{" ? file : name);  // unnamed: of this file alone
      }
      const bool type = line.starts_with("struct ") || line.starts_with("class ") || line.starts_with("enum ");
      if (!type || line.ends_with(";") || line.find('<') != std::string::npos) continue;
      words >> name;
      if (name == "class") words >> name;
      if (const auto colon = name.find(':'); colon != std::string::npos) continue;  // Outer::Inner, in one file alone
      std::string whole;
      for (const std::string& space : spaces) whole += space + "::";
      ++types;
      const auto [entry, first] = found.emplace(whole + name, file);
      if (!first) FAIL_CHECK(whole << name << " is declared in " << entry->second << " and in " << file);
    }
  }
  CHECK(types > 0);
}

TEST_CASE("HDF5's library is known to one file of rvelab") {
  std::vector<std::string> knowing;
  for (const std::string& file : code_under("rvelab")) {
    for (const auto& name : includes_of(file, '<')) {
      if (name.starts_with("hdf5") || name.starts_with("H5")) knowing.push_back(file);
    }
  }
  CHECK(knowing == std::vector<std::string>{"rvelab/io/hdf5/library.hpp"});
}

TEST_CASE("text of the libraries is written by TextStream, whatever locale a host has made the global one") {
  for (const std::string& file : code_under("rvelab")) {
    if (file.starts_with("rvelab/cli/") || file == "rvelab/error.hpp") continue;
    CAPTURE(file);
    CHECK(text_of(root / file).find("std::ostringstream") == std::string::npos);
  }
}
