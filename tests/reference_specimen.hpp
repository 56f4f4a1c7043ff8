// The packings of YADE in tests/data/yade, at rest, with their contacts.
#pragma once

#include <string>
#include <vector>

#include "rvelab/io/import/csv.hpp"

namespace rvelab {

inline Specimen reference_specimen(const std::string& name, const std::vector<std::string>& settings = {}) {
  const std::string path = RVELAB_TEST_DATA "/yade/" + name;
  io::ImportOptions options;
  options.settings = settings;
  if (name == "soft100") options.settings.push_back("solver.max_overlap_ratio=0.3");  // its largest is 0.2504
  return io::import_csv(path + ".particles.csv", path + ".contacts.csv", path + ".json", options);
}

}  // namespace rvelab
