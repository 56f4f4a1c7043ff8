// Bytes read as a row of choices: how an input without a format of its own says what is to be done.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace rvelab::fuzz {

using View = std::span<const std::byte>;

class Choices {
 public:
  explicit Choices(View bytes) : bytes_(bytes) {}

  bool done() const { return bytes_.empty(); }
  /// One of `number` (1 to 65536), from two bytes; 0 where they are used up.
  std::size_t below(std::size_t number) {
    std::size_t value = 0;
    for (int k = 0; k < 2 && !bytes_.empty(); ++k) {
      value = value << 8 | std::to_integer<std::size_t>(bytes_.front());
      bytes_ = bytes_.subspan(1);
    }
    return value % number;
  }
  template <class List>
  const auto& among(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  View bytes_;
};

}  // namespace rvelab::fuzz
