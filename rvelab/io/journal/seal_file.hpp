// A file without a seal, or with one, written anew with one.
#pragma once

#include <cstddef>
#include <string>

#include "rvelab/io/hdf5/specimen_file.hpp"

namespace rvelab::io {

struct SealedFile {
  FileKind kind = FileKind::specimen;
  bool had_seal = false;
  std::size_t datasets = 0;
};

/// Reads a specimen or record file that lacks its seal, because another program has made or changed it or because it is
/// of a version before 1.4, and writes everything that it holds to `output` (publish()), sealed and of its own version.
/// InputError: damaged, not rvelab's, or datasets are missing or contradict each other, or no
/// RVE can be made of one of its specimens.
SealedFile seal_file(const std::string& path, const std::string& output);

}  // namespace rvelab::io
