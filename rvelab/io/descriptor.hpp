// Files by their descriptors: what publish() and the journal share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace rvelab::io {

/// A file descriptor that closes itself; -1: none.
class Descriptor {
 public:
  explicit Descriptor(int opened = -1) : number_(opened) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();
  int number() const { return number_; }
  bool open() const { return number_ >= 0; }

 private:
  int number_;
};

/// Writes all bytes, however many calls it takes. False with errno set if it cannot: a full disc, a file beyond the
/// limit of `ulimit -f` (whose signal is ignored from then on, so that it is an error like the others).
bool write_all(int descriptor, std::span<const std::byte> bytes);

/// Reads up to bytes.size() bytes at an offset; returns how many there were.
std::size_t read_at(int descriptor, std::uint64_t offset, std::span<std::byte> bytes);

/// Makes a new name in the folder of `path` survive a power loss, where the file system offers it.
void sync_folder_of(const std::string& path);

}  // namespace rvelab::io
