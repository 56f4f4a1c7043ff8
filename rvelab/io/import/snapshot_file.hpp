// Snapshots as files: the whole state of a specimen in the bytes of Rve::save, as the laboratory in the browser gives
// them (tools/web), which has no HDF5.
#pragma once

#include <string>

#include "rvelab/specimen/specimen.hpp"

namespace rvelab::io {

/// How the name of such a file ends.
inline constexpr const char* snapshot_ending = ".rvesnap";

/// The specimen of a snapshot; an Rve of it goes on to the same bits. InputError naming the file if it is missing, cut,
/// damaged, or of a build whose specimens have other fields.
Specimen read_snapshot(const std::string& path);

}  // namespace rvelab::io
