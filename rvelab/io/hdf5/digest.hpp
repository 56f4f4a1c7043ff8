// An archive that writes nothing and runs every value through a checksum.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rvelab/io/crc32c.hpp"
#include "rvelab/io/hdf5/archive.hpp"

namespace rvelab::io {

/// CRC-32C over the bits of all values, in the order of their description: equal for equal values on every machine. A
/// field that was added later counts only where it is not the default, so that the digest of what an older file holds
/// stays what it was.
class Digest {
 public:
  std::uint32_t sum() const { return sum_; }

  template <class Value>
  void field(const std::string&, const Value& value, const std::string&) {
    add(value);
  }
  template <class Value>
  void field(const std::string&, const std::vector<Value>& values, const std::string&) {
    add(static_cast<std::uint64_t>(values.size()));
    for (const Value& value : values) add(value);
  }
  template <class Value>
  void later_field(const std::string& name, const Value& value, const std::string& units, InFiles,
                   const Value& initial) {
    if (value != initial) field(name, value, units);
  }
  template <class Item, class... Columns>
  void table(const std::string&, const std::vector<Item>& items, const Columns&... columns) {
    add(static_cast<std::uint64_t>(items.size()));
    for (const Item& item : items) (entry(item, columns), ...);
  }

 private:
  template <class Item, class Member>
  void entry(const Item& item, const Field<Item, Member>& column) {
    if (column.in_files.since == 0 || item.*column.member != Item{}.*column.member) add(item.*column.member);
  }
  template <class Value>
  void add(const Value& value) {
    if constexpr (Textual<Value>) {
      const std::string text = text_of(value) + '\0';
      sum_ = crc32c(std::as_bytes(std::span(text)), sum_);
    } else {
      typename Layout<Value>::Scalar scalars[Layout<Value>::size];
      Layout<Value>::put(value, scalars);
      sum_ = crc32c(std::as_bytes(std::span(scalars)), sum_);
    }
  }

  std::uint32_t sum_ = 0;
};

}  // namespace rvelab::io
