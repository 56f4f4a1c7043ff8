// Types, extents and values in an HDF5 file. Declared in bytes.hpp.
#include <algorithm>
#include <set>

#include "rvelab/io/hdf5/bytes.hpp"

namespace rvelab::io::hdf5 {
namespace {

[[noreturn]] void refuse_type(const std::string& what, const std::string& found) {
  throw InputError(what + " holds " + found + "; allowed: numbers and text; it is not rvelab's: leave it out");
}

[[noreturn]] void refuse_number(const std::string& what) {
  throw InputError(what +
                   " holds numbers of another layout (big-endian, or of odd sizes); allowed: little-endian "
                   "integers of 8, 16, 32 and 64 bits and floating-point numbers of 32 and 64; write them so");
}

StoredType number_type(const Part& message, bool floating, const std::string& what) {
  const auto bytes = message.get<std::uint32_t>(4);
  const auto flags = message.byte(1);
  const bool whole_width = (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8) &&
                           message.get<std::uint16_t>(8) == 0 && message.get<std::uint16_t>(10) == 8 * bytes;
  if (!whole_width || (flags & 0x41) != 0) refuse_number(what);
  if (!floating) return {{(flags & 8) != 0 ? Kind::whole : Kind::natural, bytes}};
  const std::uint8_t mantissa = bytes == 8 ? 52 : 23, exponent = bytes == 8 ? 11 : 8;
  const bool ieee = bytes >= 4 && message.byte(12) == mantissa && message.byte(13) == exponent &&
                    message.byte(14) == 0 && message.byte(15) == mantissa && (flags & 0x30) == 0x20 &&
                    message.byte(2) == 8 * bytes - 1 && message.get<std::uint32_t>(16) == (bytes == 8 ? 1023u : 127u);
  if (!ieee) refuse_number(what);
  return {{Kind::floating, bytes}};
}

/// Number of values; none: more than can be counted.
std::optional<std::uint64_t> count_of(const std::vector<std::uint64_t>& shape) {
  if (std::find(shape.begin(), shape.end(), 0u) != shape.end()) return 0;
  std::uint64_t count = 1;
  for (const std::uint64_t extent : shape) {
    if (extent > (std::uint64_t{1} << 48) / count) return std::nullopt;
    count *= extent;
  }
  return count;
}

}  // namespace

StoredType stored_type(const Part& message, const std::string& what) {
  static constexpr const char* others[] = {"",
                                           "",
                                           "times",
                                           "",
                                           "bit fields",
                                           "opaque bytes",
                                           "compounds",
                                           "references to other places",
                                           "enumerations (such as truth values of h5py)",
                                           "references to other places",
                                           "arrays"};
  const int kind = message.byte(0) & 15;
  const auto bytes = message.get<std::uint32_t>(4);
  if (kind == 0 || kind == 1) return number_type(message, kind == 1, what);
  if (kind == 3 && bytes > 0) return {{Kind::text, bytes}};
  if (kind == 9 && (message.byte(1) & 15) == 1 && bytes == 16) return {{Kind::text, bytes}, true};
  if (kind == 3 || kind > 10) message.damaged("a type is none of HDF5's");
  refuse_type(what, others[kind]);
}

std::vector<std::uint64_t> stored_shape(const Part& message, const std::string& what) {
  constexpr std::uint8_t most = 8, null = 2;
  const auto version = message.byte(0), dimensions = message.byte(1);
  if (version < 1 || version > 2) message.damaged("the extents of values are of no known version");
  if (dimensions > most) throw InputError(what + " has more than 8 dimensions; it is not rvelab's: leave it out");
  if (version == 2 && message.byte(3) == null) return {0};
  std::vector<std::uint64_t> shape;
  for (std::uint64_t k = 0; k < dimensions; ++k) shape.push_back(message.address((version == 1 ? 8 : 4) + 8 * k));
  return shape;
}

void ValueReader::larger_than_stored(const std::string& what) const {
  throw InputError(what + " says that it is larger than what is stored of it; the file is damaged: write it again");
}

/// Bytes for values that do not lie in the file as they are: all in all no more than such a file could hold.
std::span<std::byte> ValueReader::room(std::uint64_t bytes, const std::string& what) {
  const std::uint64_t most = 8 * file_.size() + (1 << 20);
  if (bytes > most || given_ > most - bytes) larger_than_stored(what);
  given_ += bytes;
  return tree_.storage.emplace_back(bytes);
}

Values ValueReader::in_place(const StoredType& type, std::vector<std::uint64_t> shape, const Part& bytes,
                             const std::string& what) {
  const auto count = count_of(shape);
  if (!count || *count > bytes.size() / type.type.bytes) larger_than_stored(what);
  const Values values{type.type, std::move(shape), bytes.span(0, *count * type.type.bytes)};
  return type.variable ? texts(values, what) : values;
}

/// A dataset in chunks, and what of it was found so far.
struct ValueReader::Chunks {
  const std::string& what;
  const std::vector<std::uint64_t>& shape;
  std::vector<std::uint64_t> chunk;  ///< its extents
  std::uint64_t value_bytes;
  std::span<std::byte> values;
  std::uint64_t found = 0;  ///< values
  std::set<std::vector<std::uint64_t>> begun;
  std::set<std::uint64_t> nodes;
};

Values ValueReader::by_layout(const StoredType& type, std::vector<std::uint64_t> shape, const Part& layout,
                              const std::string& what) {
  enum { compact, contiguous, chunked };
  const auto version = layout.byte(0), kind = layout.byte(1);
  if (version == 4 && kind == 3) {
    throw InputError(what +
                     " is a virtual dataset, whose values lie in other places; allowed: values in the file "
                     "itself; copy them into it");
  }
  if (version != 3 || kind > chunked) {
    throw InputError(what + " is stored in a layout of version " + std::to_string(version) +
                     "; allowed: 3; write the file with h5py's own settings (libver \"earliest\")");
  }
  if (kind == compact) return in_place(type, std::move(shape), layout.part(4, layout.get<std::uint16_t>(2)), what);
  const auto count = count_of(shape);
  if (!count) larger_than_stored(what);
  const std::uint64_t at = layout.address(kind == contiguous ? 2 : 3);
  if (*count == 0) return {type.variable ? Type{Kind::text, 1} : type.type, std::move(shape), {}};
  if (at == nowhere) larger_than_stored(what);
  if (kind == contiguous) return in_place(type, std::move(shape), file_.part(at, layout.address(10)), what);

  Chunks chunks{what, shape, {}, type.type.bytes, {}, 0, {}, {}};
  if (shape.empty() || layout.byte(2) != shape.size() + 1)
    layout.damaged("chunks have other dimensions than their dataset");
  for (std::size_t k = 0; k < shape.size(); ++k) chunks.chunk.push_back(layout.get<std::uint32_t>(11 + 4 * k));
  if (const auto values = count_of(chunks.chunk); !values || *values == 0) larger_than_stored(what);
  if (*count > file_.size() / chunks.value_bytes) larger_than_stored(what);
  chunks.values = room(*count * chunks.value_bytes, what);
  constexpr int highest_level = 8;
  gather(chunks, at, highest_level + 1);
  if (chunks.found != *count) larger_than_stored(what);
  const std::span<const std::byte> bytes = chunks.values;
  const Values values{type.type, std::move(shape), bytes};
  return type.variable ? texts(values, what) : values;
}

void ValueReader::gather(Chunks& chunks, std::uint64_t node, int level_above) {
  const Part bytes = file_.from(node);
  const std::uint64_t key_bytes = 8 + 8 * (chunks.shape.size() + 1);
  if (!bytes.begins("TREE") || bytes.byte(4) != 1 || bytes.byte(5) >= level_above || !chunks.nodes.insert(node).second)
    bytes.damaged("the index of chunks is none");
  const auto entries = bytes.get<std::uint16_t>(6);
  for (std::uint64_t k = 0; k < entries; ++k) {
    const std::uint64_t at = 24 + k * (key_bytes + 8), child = bytes.address(at + key_bytes);
    if (bytes.byte(5) > 0)
      gather(chunks, child, bytes.byte(5));
    else
      take_chunk(chunks, bytes.part(at, key_bytes), child);
  }
}

void ValueReader::take_chunk(Chunks& chunks, const Part& key, std::uint64_t at) {
  const std::size_t dimensions = chunks.shape.size();
  std::vector<std::uint64_t> begin(dimensions), extent(dimensions), index(dimensions, 0);
  std::uint64_t values = 1, chunk_values = 1;
  for (std::size_t k = 0; k < dimensions; ++k) {
    begin[k] = key.address(8 + 8 * k);
    if (begin[k] >= chunks.shape[k] || begin[k] % chunks.chunk[k] != 0) return;  // left from when it was larger
    extent[k] = std::min(chunks.chunk[k], chunks.shape[k] - begin[k]);
    values *= extent[k];
    chunk_values *= chunks.chunk[k];
  }
  if (!chunks.begun.insert(begin).second) key.damaged("a chunk is there twice");
  if (chunk_values > file_.size()) larger_than_stored(chunks.what);
  const auto from = file_.span(at, chunk_values * chunks.value_bytes);
  const std::uint64_t row = extent.back() * chunks.value_bytes;
  while (true) {
    std::uint64_t source = 0, target = 0;
    for (std::size_t k = 0; k < dimensions; ++k) {
      source = source * chunks.chunk[k] + index[k];
      target = target * chunks.shape[k] + begin[k] + index[k];
    }
    std::memcpy(chunks.values.data() + target * chunks.value_bytes, from.data() + source * chunks.value_bytes, row);
    std::size_t k = dimensions - 1;
    while (k > 0 && ++index[k - 1] == extent[k - 1]) index[--k] = 0;
    if (k == 0) break;
  }
  chunks.found += values;
}

/// Texts of variable length, as files before 1.4 and h5py have them: each a length and a place in the global heap. They
/// become texts of the length of the longest.
Values ValueReader::texts(const Values& references, const std::string& what) {
  const Part each(references.bytes, path_);
  const std::uint64_t count = references.bytes.size() / references.type.bytes;
  std::vector<std::span<const std::byte>> found;
  std::uint64_t longest = 1;
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto length = each.get<std::uint32_t>(16 * k);
    found.push_back(length == 0
                        ? std::span<const std::byte>()
                        : heap_object(each.address(16 * k + 4), each.get<std::uint32_t>(16 * k + 12)).span(0, length));
    longest = std::max<std::uint64_t>(longest, length);
  }
  const auto letters = room(count * longest, what);
  for (std::uint64_t k = 0; k < count; ++k) {
    std::copy(found[k].begin(), found[k].end(), letters.begin() + std::ptrdiff_t(k * longest));
  }
  return {{Kind::text, std::uint32_t(longest)}, references.shape, letters};
}

Part ValueReader::heap_object(std::uint64_t collection, std::uint32_t index) {
  auto known = heaps_.find(collection);
  if (known == heaps_.end()) {
    known = heaps_.emplace(collection, std::map<std::uint32_t, Part>()).first;
    const Part head = file_.from(collection);
    if (!head.begins("GCOL")) head.damaged("a text is not where it should be");
    const Part heap = file_.part(collection, head.address(8));
    for (std::uint64_t at = 16; at + 16 <= heap.size();) {
      const auto number = heap.get<std::uint16_t>(at);
      if (number == 0) break;  // the rest is free
      if (++heap_objects_ > file_.size() / 16) file_.damaged("heaps of texts lie in one another");
      const std::uint64_t size = heap.address(at + 8);
      known->second.emplace(number, heap.part(at + 16, size));
      at += 16 + (size + 7) / 8 * 8;
    }
  }
  const auto object = known->second.find(index);
  if (object == known->second.end()) file_.damaged("a text is not where it should be");
  return object->second;
}

}  // namespace rvelab::io::hdf5
