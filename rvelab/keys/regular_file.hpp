// Whole files, read once: by the program's readers and by hosts that link none of them, hence without a source.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "rvelab/error.hpp"

namespace rvelab::keys {

/// The bytes of a file as a std::string or a vector of bytes. `wanted`: what messages ask for, "a CSV file".
/// InputError: missing, a folder, a pipe or a device (which may have no end), larger than `most` bytes, not readable.
template <class Bytes>
Bytes whole_file(const std::string& path, const std::string& wanted, std::uint64_t most = std::uint64_t{1} << 46) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(path + ": " + what + "; give the path of " + wanted);
  };
  struct Opened {
    int number;
    ~Opened() {
      if (number >= 0) ::close(number);
    }
  };
  struct stat status;
  // Without O_NONBLOCK a pipe would wait for a writer.
  const Opened file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (file.number < 0 && (errno == ENOENT || errno == ENOTDIR)) refuse("no such file");
  if (file.number < 0 || ::fstat(file.number, &status) != 0) {
    refuse("cannot be opened (" + std::string(std::strerror(errno)) + "), check the permissions");
  }
  if (!S_ISREG(status.st_mode)) refuse("is not a regular file");
  const auto size = std::uint64_t(status.st_size);
  if (size > most) {
    refuse("has " + std::to_string(size) + " bytes; allowed: up to " + std::to_string(most));
  }
  Bytes bytes;
  bytes.resize(size);
  const auto room = std::as_writable_bytes(std::span(bytes.data(), bytes.size()));
  std::size_t done = 0;
  while (done < room.size()) {
    const auto count = ::read(file.number, room.data() + done, room.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse("cannot be read (" + std::string(std::strerror(errno)) + ")");
    if (count == 0) break;  // shorter than it was a moment ago
    done += std::size_t(count);
  }
  bytes.resize(done);
  return bytes;
}

}  // namespace rvelab::keys
