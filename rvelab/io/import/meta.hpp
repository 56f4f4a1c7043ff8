// META.json of a packing: law, parameters, cell and stress level, keys as in csv.hpp.
#pragma once

#include <optional>
#include <string>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// Contents of META.json. InputError: a missing key that is not optional, one of the wrong kind or out of range.
struct Meta {
  int dimension;
  std::optional<Matrix3> cell;      ///< m, cell vectors as columns, laboratory frame; 2D: (2, 2) is the thickness
  std::optional<double> thickness;  ///< m, 2D
  double reference_pressure;        ///< Pa, 0 if the file has none
  std::optional<std::size_t> particles, contacts;  ///< rows that the tables beside it have
};

/// Reads the file; with `parameters`, sets the material, law and rolling of the specimen from it.
Meta read_meta(const std::string& path, Specimen& specimen, bool parameters);

}  // namespace rvelab::io
