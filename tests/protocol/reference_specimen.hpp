// Specimens for protocol tests: reference packings as they were recorded, at rest.
#pragma once

#include <string>

#include "rvelab/io/import/csv.hpp"

namespace rvelab {

inline Specimen reference_specimen(const std::string& name) {
  const std::string path = RVELAB_TEST_DATA "/yade/" + name;
  return io::import_csv(path + ".particles.csv", path + ".contacts.csv", path + ".json", {});
}

}  // namespace rvelab
