// The bytes of an HDF5 file, asked for with care: what lies beyond them is damage. For read*.cpp alone.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/tree.hpp"

namespace rvelab::io::hdf5 {

/// A part of a file. InputError "is damaged" if one asks for more than it has.
class Part {
 public:
  Part(std::span<const std::byte> bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  std::uint64_t size() const { return bytes_.size(); }
  Part part(std::uint64_t at, std::uint64_t size) const { return {span(at, size), path_}; }
  Part from(std::uint64_t at) const { return at > size() ? part(at, 0) : part(at, size() - at); }
  std::span<const std::byte> span(std::uint64_t at, std::uint64_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) damaged("it ends before what it points to");
    return bytes_.subspan(at, size);
  }

  template <class Number>
  Number get(std::uint64_t at) const {
    static_assert(std::is_unsigned_v<Number>);
    Number number;
    std::memcpy(&number, span(at, sizeof number).data(), sizeof number);
    return number;
  }
  std::uint64_t address(std::uint64_t at) const { return get<std::uint64_t>(at); }
  std::uint8_t byte(std::uint64_t at) const { return get<std::uint8_t>(at); }

  bool begins(const char* mark) const {
    const std::size_t length = std::strlen(mark);
    return size() >= length && std::memcmp(bytes_.data(), mark, length) == 0;
  }
  std::string text(std::uint64_t at, std::uint64_t length) const {
    const auto letters = span(at, length);
    return {reinterpret_cast<const char*>(letters.data()), letters.size()};
  }
  std::string text_to_nul(std::uint64_t at) const {
    constexpr std::uint64_t longest = 1024;
    for (std::uint64_t length = 0; length < longest; ++length) {
      if (byte(at + length) == 0) return text(at, length);
    }
    damaged("a name has no end");
  }

  [[noreturn]] void damaged(const std::string& what) const {
    throw InputError(path_ + ": is damaged (" + what +
                     "); copy it again from where it was made, or write it again; nothing of it was read");
  }

 private:
  std::span<const std::byte> bytes_;
  const std::string& path_;
};

/// What a message says of the values: their type, with what only a reader needs to know.
struct StoredType {
  Type type;
  bool variable = false;  ///< texts of variable length, behind references into the global heap
};

/// InputError naming `what` if the type is neither a number nor text, or there are more dimensions than rvelab knows.
StoredType stored_type(const Part& message, const std::string& what);
std::vector<std::uint64_t> stored_shape(const Part& message, const std::string& what);

/// Reads values wherever they are.
class ValueReader {
 public:
  ValueReader(const Part& file, Tree& tree, const std::string& path) : file_(file), tree_(tree), path_(path) {}

  /// Values that lie in a part of the file, in one piece.
  Values in_place(const StoredType& type, std::vector<std::uint64_t> shape, const Part& bytes, const std::string& what);
  /// Values of a dataset by its layout message.
  Values by_layout(const StoredType& type, std::vector<std::uint64_t> shape, const Part& layout,
                   const std::string& what);

 private:
  struct Chunks;
  std::span<std::byte> room(std::uint64_t bytes, const std::string& what);
  void gather(Chunks& chunks, std::uint64_t node, int level_above);
  void take_chunk(Chunks& chunks, const Part& key, std::uint64_t at);
  Values texts(const Values& references, const std::string& what);
  Part heap_object(std::uint64_t collection, std::uint32_t index);
  [[noreturn]] void larger_than_stored(const std::string& what) const;

  const Part& file_;
  Tree& tree_;
  const std::string& path_;
  std::uint64_t given_ = 0;  ///< bytes of room so far
  std::map<std::uint64_t, std::map<std::uint32_t, Part>> heaps_;
  std::uint64_t heap_objects_ = 0;
};

}  // namespace rvelab::io::hdf5
