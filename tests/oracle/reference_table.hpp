// Recorded data under tests/data: tables with named columns, and JSON.
#pragma once

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "rvelab/cell/cell.hpp"

namespace rvelab::test {

inline std::string data_path(const std::string& name) { return std::string(RVELAB_TEST_DATA) + "/" + name; }

inline nlohmann::json recorded_json(const std::string& name) {
  std::ifstream file(data_path(name));
  if (!file) throw std::runtime_error("missing test data " + name);
  return nlohmann::json::parse(file);
}

/// A CSV file; lines that start with # are kept apart as its comment.
class RecordedTable {
 public:
  explicit RecordedTable(const std::string& name) : name_(name) {
    std::ifstream file(data_path(name));
    if (!file) throw std::runtime_error("missing test data " + name);
    for (std::string line, cell; std::getline(file, line);) {
      if (!line.empty() && line[0] == '#') comment_ += line + "\n";
      if (line.empty() || line[0] == '#') continue;
      std::vector<std::string> cells;
      for (std::istringstream stream(line); std::getline(stream, cell, ',');) cells.push_back(cell);
      if (columns_.empty()) {
        columns_ = cells;
        continue;
      }
      std::vector<double> numbers;
      for (const auto& text : cells) numbers.push_back(std::stod(text));
      if (numbers.size() != columns_.size()) throw std::runtime_error(name + ": a row of another length");
      rows_.push_back(numbers);
    }
    if (rows_.empty()) throw std::runtime_error(name + " has no rows");
  }

  std::size_t rows() const { return rows_.size(); }
  const std::string& comment() const { return comment_; }
  const std::vector<std::string>& columns() const { return columns_; }

  double at(std::size_t row, const std::string& column) const {
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    if (found == columns_.end()) throw std::runtime_error(name_ + " has no column " + column);
    return rows_.at(row)[std::size_t(found - columns_.begin())];
  }

  /// Columns PREFIXxSUFFIX, PREFIXySUFFIX, PREFIXzSUFFIX.
  Vector3 vector(std::size_t row, const std::string& prefix, const std::string& suffix) const {
    return {at(row, prefix + "x" + suffix), at(row, prefix + "y" + suffix), at(row, prefix + "z" + suffix)};
  }

 private:
  std::string name_, comment_;
  std::vector<std::string> columns_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace rvelab::test
