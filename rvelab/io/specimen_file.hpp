// A specimen as an HDF5 file, S.h5: everything that decides its next bit, out and back bitwise, under names that a
// person can read (rvelab/io/README.md lists them).
#pragma once

#include <string>

#include "rvelab/solver/specimen.hpp"

namespace rvelab {

/// What an rvelab file holds.
enum class FileKind { specimen, records };

/// Writes a specimen: S.h5.tmp, synced, then renamed to `path`. Throws InputError if the place cannot be written to,
/// Error if the writing fails; `path` is then as it was.
void write_specimen(const Specimen& specimen, const std::string& path);

/// Reads the specimen of a specimen file, or the end state of a record file. Throws InputError naming the file and
/// what is wrong: missing, not HDF5, truncated, of a newer format, not rvelab's, indices out of range.
Specimen read_specimen(const std::string& path);

/// Kind of an rvelab file. Throws InputError as read_specimen does.
FileKind file_kind(const std::string& path);

}  // namespace rvelab
