// What an HDF5 file holds, in memory, and the way from its bytes and back, by HDF5's library (library.hpp).
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

  friend bool operator==(const Type&, const Type&) = default;
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

/// What is in the bytes of a file; `path` serves the messages. They should be what rvelab or h5py has written, as a
/// seal or a checksum vouches for: HDF5's library can be crashed by bytes that were made for it. InputError naming the
/// object: what leads out of the file (external links and storage, virtual datasets), links of the same object or to a
/// name, datasets in chunks or filtered, types that are neither numbers nor text of fixed length, datasets that are
/// larger than what is stored of them, groups in groups beyond most_nested, a newer superblock, damage.
Tree read(const std::string& path, std::span<const std::byte> file);

/// The bytes of a file with these objects; with one version of the library equal trees give equal bytes.
std::vector<std::byte> write(const Tree& tree);

inline constexpr int most_nested = 32;

}  // namespace rvelab::io::hdf5
