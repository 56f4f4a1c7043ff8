// Nine discs of tests/data/nine_discs, at rest.
#pragma once

#include <string>

#include "rvelab/io/import/csv.hpp"

namespace rvelab::test {

inline Specimen nine_discs() {
  const std::string folder = RVELAB_TEST_DATA "/nine_discs/";
  io::ImportOptions options;
  options.cell = Vector3(0.03, 0.03, 0.1);
  options.material_path = folder + "soil.toml";
  return io::import_csv(folder + "grains.csv", std::nullopt, std::nullopt, options);
}

}  // namespace rvelab::test
