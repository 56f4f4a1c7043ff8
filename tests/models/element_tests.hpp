// Tests for the models to calculate, and kept ones to hold them against.
#pragma once

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tools/models/element.hpp"

namespace rvelab::test {

using models::ElementTest;
using models::Loading;

/// Natural strain of one of the laboratory, 1 - F_aa.
inline double natural(double strain) { return -std::log1p(-strain); }

inline void add_row(ElementTest& test, double strain, double p) {
  test.strain.push_back(strain);
  test.q.push_back(0);
  test.p.push_back(p);
  test.eps_v.push_back(0);
}

/// Rows to an axial strain; closer at the start.
inline ElementTest sheared(std::string name, Loading loading, double p0, double e0, double to, int rows = 40) {
  ElementTest test;
  test.name = std::move(name), test.loading = loading, test.p0 = p0, test.e0 = e0;
  for (int k = 0; k <= rows; ++k) add_row(test, to * std::pow(double(k) / rows, 1.5), p0);
  return test;
}

/// Rows from p0 through these stresses: axial ones of an oedometer, mean ones of isotropic compression.
inline ElementTest compressed(std::string name, Loading loading, double p0, double e0,
                              const std::vector<double>& stresses, int rows = 10) {
  ElementTest test;
  test.name = std::move(name), test.loading = loading, test.p0 = p0, test.e0 = e0;
  double last = p0;
  add_row(test, 0, p0);
  for (const double stress : stresses) {
    for (int k = 1; k <= rows; ++k) add_row(test, 0, last * std::pow(stress / last, double(k) / rows));
    last = stress;
  }
  return test;
}

/// What a law makes of a test, as if it had been measured.
inline ElementTest by(const models::Law& law, const ElementTest& test, bool fitted = true) {
  ElementTest result = models::calculate(law, test).test;
  result.fitted = fitted;
  return result;
}

/// Rows of a kept table, its columns by their names; lines that begin with # are left out.
inline std::vector<std::map<std::string, std::string>> kept(const std::string& file) {
  std::ifstream input(std::string(RVELAB_TEST_DATA) + "/models/" + file);
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> rows;
  for (std::string line; std::getline(input, line);) {
    if (line.starts_with("#")) continue;
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    auto& row = rows.emplace_back();
    for (std::size_t k = 0; k < names.size(); ++k) row[names[k]] = cells.at(k);
  }
  return rows;
}

/// Drained tests on Karlsruhe fine sand, as measured.
inline std::vector<ElementTest> karlsruhe_drained() {
  std::vector<ElementTest> tests;
  for (const auto& row : kept("karlsruhe_drained.csv")) {
    const double q = std::stod(row.at("q")) * 1e3, p = std::stod(row.at("p")) * 1e3;
    if (tests.empty() || tests.back().name != row.at("test")) {
      ElementTest& test = tests.emplace_back();
      test.name = row.at("test"), test.loading = Loading::drained;
      test.p0 = p - q / 3, test.e0 = std::stod(row.at("e"));
    }
    tests.back().strain.push_back(std::stod(row.at("eps_a")) / 100);
    tests.back().eps_v.push_back(std::stod(row.at("eps_v")) / 100);
    tests.back().q.push_back(q);
    tests.back().p.push_back(p);
  }
  return tests;
}

}  // namespace rvelab::test
