// Comparison of two files, bit by bit: `rvelab compare`, and every test of a restart.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace rvelab::io {

struct Comparison {
  std::size_t datasets = 0;               ///< compared and found equal
  std::optional<std::string> difference;  ///< one line: the first object that differs, the index, both values
};

/// Compares every group, dataset and attribute of two HDF5 files outside /provenance, in the order of their names:
/// names, types, shapes, attributes, bits. NaNs of the same bits are equal; 0 and -0 are not. InputError if one of the
/// files cannot be read.
Comparison compare_files(const std::string& path_a, const std::string& path_b);

}  // namespace rvelab::io
