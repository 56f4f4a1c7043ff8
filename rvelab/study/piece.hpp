// A piece of a study: what one whole path, or the increments of one grid point on one specimen, gave. Pieces are
// numbers in columns by name, so that whoever keeps them need not know what they mean.
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace rvelab::study {

/// A value that could not be found.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

struct Piece {
  std::map<std::string, std::vector<double>> columns;
  std::string failure;  ///< why something of it could not be carried out, the first reason; empty: all was

  const std::vector<double>& column(const std::string& name) const { return columns.at(name); }
};

// Names of pieces. Point 0 is the reference, grid points count from 1 here; specimens and repeats from 1.
inline std::string path_piece(std::size_t point, std::size_t specimen, std::size_t repeat) {
  return "path_" + std::to_string(point) + "_" + std::to_string(specimen) + "_" + std::to_string(repeat);
}
inline std::string increments_piece(std::size_t point, std::size_t specimen) {
  return "increments_" + std::to_string(point) + "_" + std::to_string(specimen);
}

}  // namespace rvelab::study
