// Numbers of a state in a page: little-endian arrays, compressed (zlib) and as base64.
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

  /// 0 to 65534 for `low` to `high`, 65535 for NaN. The page divides by 65534.
  void add_within(double value, double low, double high);
  /// Fraction of a period: 0 to 65535 for 0 to 1; 1 is equal to 0.
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
