// Messages between ranks: values one after the other, as they lie in memory. All ranks run the same build.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "rvelab/pool/status.hpp"

namespace rvelab::ranks {

using Bytes = std::vector<std::byte>;

class Packer {
 public:
  template <class Value>
  requires std::is_trivially_copyable_v<Value> Packer& put(const Value& value) {
    add(&value, sizeof value);
    return *this;
  }
  /// Their number, then the values.
  template <class Value>
  requires std::is_trivially_copyable_v<Value> Packer& put_all(std::span<const Value> values) {
    put(values.size());
    add(values.data(), values.size_bytes());
    return *this;
  }
  Packer& put_text(const std::string& text) { return put_all(std::span<const char>(text)); }
  /// Bytes that end the message, without their number (Unpacker::rest).
  Packer& put_rest(std::span<const std::byte> bytes) {
    add(bytes.data(), bytes.size());
    return *this;
  }
  Bytes take() { return std::move(bytes_); }

 private:
  void add(const void* from, std::size_t size) {
    if (size == 0) return;
    const std::size_t before = bytes_.size();
    bytes_.resize(before + size);
    std::memcpy(bytes_.data() + before, from, size);
  }

  Bytes bytes_;
};

/// Takes values out in the order that they were put in. Throws Refused (internal) if the message ends before.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::byte> bytes) : left_(bytes) {}

  template <class Value>
  requires std::is_trivially_copyable_v<Value> Value take() {
    Value value;
    std::memcpy(&value, some(sizeof value).data(), sizeof value);
    return value;
  }
  template <class Value>
  std::vector<Value> take_all() {
    const auto n = take<std::size_t>();
    if (n > left_.size() / sizeof(Value)) some(left_.size() + 1);
    std::vector<Value> values(n);
    if (n > 0) std::memcpy(values.data(), some(n * sizeof(Value)).data(), n * sizeof(Value));
    return values;
  }
  std::string take_text() {
    const std::vector<char> text = take_all<char>();
    return {text.begin(), text.end()};
  }
  std::span<const std::byte> rest() const { return left_; }

 private:
  std::span<const std::byte> some(std::size_t size) {
    if (size > left_.size())
      throw pool::Refused(pool::Status::internal, "a message between ranks ends early: please report this");
    const auto found = left_.first(size);
    left_ = left_.subspan(size);
    return found;
  }

  std::span<const std::byte> left_;
};

}  // namespace rvelab::ranks
