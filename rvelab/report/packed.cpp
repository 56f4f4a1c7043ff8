#include "rvelab/report/packed.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "rvelab/error.hpp"

namespace rvelab::report {

void Packed::add(float value) { add(std::bit_cast<std::uint32_t>(value)); }

void Packed::add_within(double value, double low, double high) {
  constexpr double steps = 65534;
  if (!std::isfinite(value)) return add(std::uint16_t{65535});
  const double part = high > low ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0.0;
  add(static_cast<std::uint16_t>(std::lround(part * steps)));
}

void Packed::add_part(double part) {
  add(static_cast<std::uint16_t>(std::lround((part - std::floor(part)) * 65536) & 0xffff));
}

std::string Packed::text() const {
  std::vector<std::uint8_t> packed(compressBound(bytes_.size()));
  uLongf length = packed.size();
  if (compress2(packed.data(), &length, bytes_.data(), bytes_.size(), Z_BEST_COMPRESSION) != Z_OK)
    throw Error("report: zlib could not compress a state of " + std::to_string(bytes_.size()) +
                " bytes; is there memory left?");
  packed.resize(length);
  return base64(packed);
}

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - k);
    std::uint32_t three = 0;
    for (std::size_t b = 0; b < 3; ++b) three = three << 8 | (b < left ? bytes[k + b] : 0u);
    for (std::size_t c = 0; c < 4; ++c) text += c <= left ? letters[three >> (18 - 6 * c) & 63] : '=';
  }
  return text;
}

}  // namespace rvelab::report
