// A pool as an HDF5 file: every RVE with its id, its tokens and the trials that can still be accepted. Described in
// rvelab/io/README.md; read by every later version 1.x.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rvelab/pool/pool.hpp"

namespace rvelab::h5 {

/// `state(k)`: bytes of the k-th RVE (pool::to_bytes). Throws InputError or Error as io::write_specimen; the file is
/// then as it was.
void write_pool(const std::string& path, const pool::Population& population,
                const std::function<std::vector<std::byte>(std::size_t)>& state);

/// Shows the bytes of each RVE to `take`, in the order of the ids. InputError: missing, damaged, of a newer format, no
/// pool file.
pool::Population read_pool(const std::string& path, const std::function<void(std::span<const std::byte>)>& take);

}  // namespace rvelab::h5
