// What numbers of a scene may be, by their units: far beyond what soils, rocks and laboratories have, and so narrow
// that products of them (masses, moments of inertia, frequencies) are normal numbers.
#pragma once

#include <string>

namespace mpm {

/// least: of what must be positive; most: of the magnitude of all.
struct Range {
  const char* unit;  ///< "1" of numbers without one
  double least, most;
};

/// Of a key, whose name ends with its unit: young_modulus_Pa.
Range range_of(const std::string& key);

}  // namespace mpm
