// Work on a file that may be damaged, done by a child process: whatever becomes of the child, this process goes on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "rvelab/io/descriptor.hpp"

namespace rvelab::io {

/// A file in memory with the bytes that `make` returns. It is called in a child process (fork) with limits on time and
/// memory that go by the `size` of the file `path` in bytes. The child is this thread alone: `make` must not wait for
/// other threads. InputError: that which `make` throws, or "damaged" if the child crashes, finds no end or asks for
/// more memory than such a file can hold. Error: no process, or no memory, was to be had.
Descriptor made_in_child(const std::string& path, std::uint64_t size,
                         const std::function<std::vector<std::byte>()>& make);

}  // namespace rvelab::io
