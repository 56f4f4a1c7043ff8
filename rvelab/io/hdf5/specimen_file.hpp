// A specimen as an HDF5 file, S.h5: everything that decides its next bit, out and back bitwise, under names that a
// person can read (rvelab/io/README.md lists them).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// What an rvelab file holds.
enum class FileKind { specimen, records };

/// How a specimen was packed: with this it can be made again.
struct SpecimenOrigin {
  std::string recipe;  ///< with every default and setting, TOML
  std::uint64_t seed = 0;
  std::int64_t draw = 0;            ///< that was accepted, from 1
  double preparation_friction = 0;  ///< of that draw
  /// Of its agitated grains (pack::Agitation), given or found; none: they were not agitated.
  std::optional<double> expansion = {}, strain_difference = {};
};

/// Writes a specimen, under /provenance how it came about if that is given: S.h5.tmp, synced, then renamed to `path`.
/// Throws InputError if the place cannot be written to, Error if the writing fails; `path` is then as it was.
void write_specimen(const Specimen& specimen, const std::string& path, const SpecimenOrigin* origin = nullptr);

/// How the specimen of a specimen file was packed; none if it was not. Throws InputError as read_specimen does.
std::optional<SpecimenOrigin> read_origin(const std::string& path);

/// Reads the specimen of a specimen file, the end state of a record file, or the RVE of a pool file that holds it
/// alone. Throws InputError naming the file and what is wrong: missing, not HDF5, truncated, of another version, not
/// rvelab's, a field out of its range (check_specimen), a pool of many, without its seal.
Specimen read_specimen(const std::string& path);

/// Kind of an rvelab file. Throws InputError as read_specimen does.
FileKind file_kind(const std::string& path);

struct Comparison {
  std::size_t datasets = 0;               ///< compared and found equal
  std::optional<std::string> difference;  ///< one line: the first object that differs, the index, both values
};

/// Compares every group, dataset and attribute of two HDF5 files outside /provenance, in the order of their names:
/// names, types, shapes, attributes, bits. NaNs of the same bits are equal; 0 and -0 are not. InputError if one of the
/// files cannot be read.
Comparison compare_files(const std::string& path_a, const std::string& path_b);

}  // namespace rvelab::io
