// Format and version of rvelab's files, and a specimen as a group of any of them.
#pragma once

#include <string>

#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"

namespace rvelab::io {

/// Version of the layout; no other one is read.
inline constexpr const char* format_version = "2.1";

/// Sets the file's attributes `format` and `format_version`.
void stamp(Hdf5File& file, FileKind kind);
void stamp(Hdf5File& file, const std::string& format);
/// InputError: of another version.
void expect_version(const Hdf5File& file);

/// Checks the attributes of a file that must be of this format. InputError as checked_kind.
void check_format(const Hdf5File& file, const std::string& format);

/// Format of the file of a pool (rvelab/h5), whose RVEs are groups of this one.
inline constexpr const char* pool_format = "rvelab pool";
inline constexpr const char* pool_rves = "/rves";

/// Checks the attributes and returns the kind; a pool is of the kind specimen. InputError: not rvelab's, or of another
/// version.
FileKind checked_kind(const Hdf5File& file);
/// Whether its attribute `format` is one of rvelab's.
bool is_rvelab(const Hdf5File& file);

/// Writes a specimen under a group ("" for the root), or reads it from there and checks it (check_specimen).
void put_specimen(Hdf5File& file, const std::string& group, const Specimen& specimen);
Specimen get_specimen(const Hdf5File& file, const std::string& group);
/// Its bits as they are stored, whatever they mean.
Specimen stored_specimen(const Hdf5File& file, const std::string& group);
/// How the specimen of a specimen file was packed; none if it was not, or of another file.
std::optional<SpecimenOrigin> get_origin(const Hdf5File& file);
/// Group of the specimen of a file: of records the end state, of a pool its RVE. InputError: a pool of none or many.
std::string specimen_group(const Hdf5File& file);

/// CRC-32C over every bit of a specimen, in the order of its description: equal for equal specimens on every machine.
std::uint32_t digest(const Specimen& specimen);

}  // namespace rvelab::io
