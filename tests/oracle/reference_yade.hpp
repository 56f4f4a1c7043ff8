// YADE's recorded packings and paths (tests/data/yade).
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "rvelab/io/import_csv.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/oracle/reference_table.hpp"

namespace rvelab::test {

/// A packing with its contacts, and YADE's slip convention.
inline Specimen yade_packing(const std::string& name) {
  ImportOptions options;
  options.settings = {"contact.slip=full_radius_ratcheting"};
  const std::string stem = data_path("yade/" + name);
  return import_csv(stem + ".particles.csv", stem + ".contacts.csv", stem + ".json", options);
}

/// The stress that YADE reports for a packing, Pa, tension positive.
inline Matrix3 yade_stress(const std::string& name) {
  const auto rows = recorded_json("yade/" + name + ".json").at("stress_tension_positive_Pa");
  Matrix3 stress = Matrix3::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < rows[i].size(); ++j) stress(int(i), int(j)) = rows[i][j].get<double>();
  return stress;
}

/// A number of a path's comment, "rate = 0.06 1/s" or "dt = 2e-5 s".
inline double stated(const RecordedTable& path, const std::string& name) {
  const auto at = path.comment().find(name + " ");
  if (at == std::string::npos) throw std::runtime_error("the path does not state " + name);
  const auto equals = path.comment().find_first_of("=0123456789", at);
  const auto number = path.comment().find_first_of("0123456789", equals);
  return std::stod(path.comment().substr(number));
}

}  // namespace rvelab::test
