// The program on a scene in a folder of its own: runs that are started, stopped and resumed, and their files.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/child.hpp"
#include "tests/folder.hpp"

namespace mpm::test {

/// A table of a run, history.csv or watched.csv, by the names of its columns.
struct History {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  explicit History(const std::string& path) {
    std::istringstream text(rvelab::test::bytes_of(path));
    std::string line, cell;
    std::getline(text, line);
    for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell);
    while (std::getline(text, line)) {
      rows.emplace_back();
      for (std::istringstream row(line); std::getline(row, cell, ',');) rows.back().push_back(std::stod(cell));
    }
  }
  double at(std::size_t row, const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw std::runtime_error("no column " + name);
    return rows.at(row).at(std::size_t(found - names.begin()));
  }
  double last(const std::string& name) const { return at(rows.size() - 1, name); }
};

struct SceneRuns {
  rvelab::test::Folder folder;
  std::string scene;  ///< path of the scene

  explicit SceneRuns(const std::string& text, const std::string& file = "scene.toml") : scene(folder / file) {
    std::ofstream(scene) << text;
  }
  /// The status that rvelab-mpm ends with.
  int run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), RVELAB_MPM_PROGRAM);
    return rvelab::test::Child(arguments, folder / "out", folder / "err").wait();
  }
  /// A run of the scene into a folder of this name.
  int start(const std::string& name, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {scene, "-o", folder / name});
    return run(more);
  }
  int resume(const std::string& name, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"--resume", folder / name});
    return run(more);
  }
  History history(const std::string& name) const { return History(folder / (name + "/history.csv")); }
  std::string errors() const { return rvelab::test::bytes_of(folder / "err"); }
  std::string output() const { return rvelab::test::bytes_of(folder / "out"); }
  /// Two runs of at least so many files have the same bytes in each.
  void expect_same(const std::string& a, const std::string& b, std::size_t least) const {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / a)) {
      const auto name = entry.path().filename().string();
      CAPTURE(a, b, name);
      ++files;
      CHECK(rvelab::test::bytes_of(entry.path()) == rvelab::test::bytes_of(folder / (b + "/" + name)));
    }
    CHECK(files >= least);
  }
};

}  // namespace mpm::test
