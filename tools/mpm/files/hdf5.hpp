// HDF5 behind two small classes: arrays of doubles and of whole numbers, by their names. A file is made in
// memory, written beside its name and renamed once it is whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace mpm {

using Extents = std::vector<std::size_t>;

class OutputFile {
 public:
  explicit OutputFile(const std::string& path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();
  void write(const std::string& name, const std::vector<double>& values, const Extents& extents);
  void write(const std::string& name, const std::vector<std::int64_t>& values);
  /// publish_file, with the seal of rvelab/io/hdf5/seal.hpp behind it if the file is to be read back: InputFile wants
  /// it.
  void publish(bool sealed = false);

 private:
  void put(const std::string& name, std::int64_t type, const void* values, const Extents& extents);
  std::string path_;
  std::int64_t file_;
};

/// Writes a file beside its name and renames it: an old one stays whole until then. InputError: not there;
/// std::runtime_error: the disc is full.
void publish_file(const std::string& path, const char* bytes, std::size_t size);

/// The bytes of a regular file; InputError: it is missing, no regular file, or cannot be read.
std::vector<std::byte> file_bytes(const std::string& path);

/// A sealed file. It is read into memory once: what the seal was compared with is what HDF5 reads.
class InputFile {
 public:
  /// InputError if it is missing, no HDF5 file, or has no seal, or another than its bytes ask for.
  explicit InputFile(const std::string& path);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();
  std::vector<double> read(const std::string& name) const;
  std::vector<std::int64_t> read_whole(const std::string& name) const;

 private:
  template <class Value>
  std::vector<Value> get(const std::string& name, std::int64_t type) const;
  std::string path_;
  std::int64_t file_ = -1;
};

}  // namespace mpm
