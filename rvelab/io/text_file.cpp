#include "rvelab/io/text_file.hpp"

#include <charconv>
#include <iterator>

#include "rvelab/io/publish.hpp"

namespace rvelab::io {

std::string exact(double value) {
  char text[32];
  return {text, std::to_chars(std::begin(text), std::end(text), value).ptr};
}

void publish_text(const std::string& path, const std::string& text) {
  publish_bytes(path, {std::as_bytes(std::span(text))});
}

}  // namespace rvelab::io
