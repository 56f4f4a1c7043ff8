// Numbers of a state as a page carries them: little-endian arrays, compressed (zlib) and as base64.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace rvelab::report {

class Packed {
 public:
  void add(std::uint8_t value) { bytes_.push_back(value); }
  void add(std::uint16_t value) { add_bytes(value, 2); }
  void add(std::uint32_t value) { add_bytes(value, 4); }
  void add(float value);

  /// 0 to 65534 for `low` to `high`, 65535 for what is not a number. A page divides by 65534 again.
  void add_within(double value, double low, double high);
  /// Part of a period: 0 to 65535 for 0 to 1, which is 0 again.
  void add_part(double part);

  std::size_t size() const { return bytes_.size(); }
  /// Compressed, base64. Error if zlib fails.
  std::string text() const;

 private:
  void add_bytes(std::uint32_t value, int count) {
    for (int k = 0; k < count; ++k) bytes_.push_back(std::uint8_t(value >> (8 * k)));
  }
  std::vector<std::uint8_t> bytes_;
};

std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace rvelab::report
