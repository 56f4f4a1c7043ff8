#include "rvelab/io/import/snapshot_file.hpp"

#include <cstddef>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/keys/regular_file.hpp"
#include "rvelab/solver/snapshot.hpp"

namespace rvelab::io {

Specimen read_snapshot(const std::string& path) {
  const auto bytes = keys::whole_file<std::vector<std::byte>>(path, "a snapshot, S.rvesnap");
  try {
    return from_bytes(bytes);
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

}  // namespace rvelab::io
