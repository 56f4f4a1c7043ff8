// What an HDF5 file holds, in memory, and the way from its bytes and back. Of the format (HDF5 File Format
// Specification, version 3.0) this is the part that rvelab writes and has always written, and that h5py writes unless
// it is told otherwise: the first version of its superblock, of groups and of object headers, datasets in one piece or
// in chunks, without filters. Every byte lies in this file: nothing leads out of it, and every object has one name.
//
// HDF5's own library is not used: it trusts the bytes that it is shown, ends the process where it gets no memory, and
// follows links to other files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rvelab::io::hdf5 {

enum class Kind : std::uint8_t { floating, whole, natural, text };

/// Numbers are little-endian; texts have a fixed length and are padded with NUL.
struct Type {
  Kind kind = Kind::floating;
  std::uint32_t bytes = 8;  ///< of one value
};

/// "float64", "int32", "uint8", "text" and so on.
std::string name(Type type);

/// Values of a dataset or an attribute, row-major.
struct Values {
  Type type;
  std::vector<std::uint64_t> shape;  ///< empty: a scalar
  std::span<const std::byte> bytes;
};

/// A group, or a dataset.
struct Object {
  std::optional<Values> dataset;
  std::map<std::string, Values> attributes;
};

/// All objects by their paths, "/" among them, and the bytes that their values lie in.
struct Tree {
  std::map<std::string, Object> objects{{"/", {}}};
  std::deque<std::vector<std::byte>> storage;
};

/// Takes a file apart; `path` serves the messages. Any bytes may be shown to it. InputError naming the object: what
/// leads out of the file (external links and storage, virtual datasets), links of the same object or to a name,
/// filters, types that are neither numbers nor text, datasets that are larger than what is stored of them, groups in
/// groups beyond most_nested, another version of the format, damage.
Tree read(const std::string& path, std::vector<std::byte> file);

/// The bytes of a file with these objects; equal trees give equal bytes.
std::vector<std::byte> write(const Tree& tree);

inline constexpr int most_nested = 32;
inline constexpr std::uint64_t nowhere = ~std::uint64_t{0};  ///< the address of what is not stored

/// Messages of object headers, by their types.
enum Message : std::uint16_t {
  dataspace_message = 0x01,
  link_info_message = 0x02,
  datatype_message = 0x03,
  fill_value_message = 0x05,
  link_message = 0x06,
  external_files_message = 0x07,
  layout_message = 0x08,
  filters_message = 0x0b,
  attribute_message = 0x0c,
  continuation_message = 0x10,
  symbol_table_message = 0x11,
  attribute_info_message = 0x15,
};

}  // namespace rvelab::io::hdf5
