#include "rvelab/io/text_file.hpp"

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <iterator>

#include "rvelab/error.hpp"

namespace rvelab::io {

std::string exact(double value) {
  char text[32];
  return {text, std::to_chars(std::begin(text), std::end(text), value).ptr};
}

void publish_text(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".tmp";
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) {
    throw InputError(path + ": cannot be written (" + std::strerror(errno) +
                     "); give a path in an existing folder that you may write to");
  }
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const bool closed = std::fclose(file) == 0;
  if (written && closed && std::rename(temporary.c_str(), path.c_str()) == 0) return;
  const std::string reason = std::strerror(errno);
  std::remove(temporary.c_str());
  throw Error(path + ": could not be written (" + reason +
              "); free space or choose another place with -o; what was there before is untouched");
}

}  // namespace rvelab::io
