// A folder of a test, which vanishes with its files; whole files as bytes.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "rvelab/error.hpp"

namespace rvelab::test {

class Folder {
 public:
  Folder() {
    // mkdtemp asks for six X at the end.
    std::string pattern = (std::filesystem::temp_directory_path() / "rvelab-test-").string() + std::string(6, 'X');
    if (mkdtemp(pattern.data()) == nullptr) throw Error("no temporary folder could be made");
    path_ = pattern;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}
inline std::string bytes_of(const std::string& path) {
  std::ifstream input(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), {}};
}

}  // namespace rvelab::test
