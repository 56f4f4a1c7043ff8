// HDF5 behind two small classes: arrays of doubles and of whole numbers, and texts, by their names. A file is made in
// memory, written beside its name and renamed once it is whole.
#pragma once

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
  void write(const std::string& name, const std::string& text);
  /// publish_file.
  void publish();

 private:
  void put(const std::string& name, std::int64_t type, const void* values, const Extents& extents);
  std::string path_;
  std::int64_t file_;
};

/// Writes a file beside its name and renames it: an old one stays whole until then. Mistake: not there;
/// std::runtime_error: the disc is full.
void publish_file(const std::string& path, const char* bytes, std::size_t size);

class InputFile {
 public:
  /// Mistake if it is missing or no HDF5 file.
  explicit InputFile(const std::string& path);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();
  std::vector<double> read(const std::string& name) const;
  std::vector<std::int64_t> read_whole(const std::string& name) const;
  std::string read_text(const std::string& name) const;

 private:
  template <class Value>
  std::vector<Value> get(const std::string& name, std::int64_t type) const;
  std::string path_;
  std::int64_t file_;
};

}  // namespace mpm
