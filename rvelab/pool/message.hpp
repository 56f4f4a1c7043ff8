// Values as bytes, one after the other as they lie in memory: calls and answers between processes of one build.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "rvelab/pool/status.hpp"

namespace rvelab::pool {

using Bytes = std::vector<std::byte>;

class Packer {
 public:
  /// Reserves memory for that many further bytes, so that putting them in cannot fail.
  Packer& make_room(std::size_t size) {
    bytes_.reserve(bytes_.size() + size);
    return *this;
  }
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
  [[gnu::noinline]] void add(const void* from, std::size_t size) {  // inlined, gcc 12 warns of bounds never exceeded
    const auto* const first = static_cast<const std::byte*>(from);
    if (size > 0) bytes_.insert(bytes_.end(), first, first + size);
  }

  Bytes bytes_;
};

/// Values where they lie in a message.
template <class Value>
class Row {
 public:
  Row() = default;
  explicit Row(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::size_t size() const { return bytes_.size() / sizeof(Value); }
  Value operator[](std::size_t k) const {
    Value value;
    std::memcpy(&value, bytes_.data() + k * sizeof value, sizeof value);
    return value;
  }
  /// Copies `count` of them from the k-th on.
  void copy(std::size_t k, std::size_t count, Value* to) const {
    if (count > 0) std::memcpy(to, bytes_.data() + k * sizeof(Value), count * sizeof(Value));
  }

 private:
  std::span<const std::byte> bytes_;
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
  /// What put_all put in, where it lies: asks for no memory.
  template <class Value>
  Row<Value> take_row() {
    return Row<Value>(take_bytes<Value>());
  }
  template <class Value>
  std::vector<Value> take_all() {
    const auto row = take_row<Value>();
    std::vector<Value> values(row.size());
    row.copy(0, values.size(), values.data());
    return values;
  }
  /// The text where it lies.
  std::string_view take_text() {
    const auto bytes = take_bytes<char>();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  std::span<const std::byte> rest() const { return left_; }
  /// The bytes of what put_all put in, where they lie.
  template <class Value = std::byte>
  std::span<const std::byte> take_bytes() {
    const auto n = take<std::size_t>();
    if (n > left_.size() / sizeof(Value)) some(left_.size() + 1);
    return some(n * sizeof(Value));
  }

 private:
  std::span<const std::byte> some(std::size_t size) {
    if (size > left_.size()) throw Refused(Status::internal, "a message between ranks ends early: please report this");
    const auto found = left_.first(size);
    left_ = left_.subspan(size);
    return found;
  }

  std::span<const std::byte> left_;
};

}  // namespace rvelab::pool
