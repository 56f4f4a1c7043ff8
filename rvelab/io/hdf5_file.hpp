// HDF5 behind one small class: typed arrays, text and attributes by name; its errors as rvelab's own.
//
// hdf5_*.cpp know HDF5 and nothing of grains; no other file includes HDF5's headers. Files are built in memory and
// written by publish(), so that no HDF5 file is ever open for writing on disc and a full disc is one plain error. What
// is written is sealed (seal.hpp), and nothing that may be damaged is shown to HDF5 in this process (hdf5_open.cpp).
// HDF5's serial library is not thread-safe: one thread at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace rvelab::io {

using Shape64 = std::vector<std::uint64_t>;  ///< extents of an array, outermost first; empty: a scalar

/// A dataset as a walk through a file finds it.
struct Hdf5Entry {
  std::string name;   ///< full path, for example "/grains/radius_m"
  std::string type;   ///< float64, int32, int64, uint64, uint8 or text
  Shape64 shape;      ///< empty: a scalar
  std::string units;  ///< its attribute `units`; "1" where it is a pure number, "-" where it is none
};

/// Values as a file stores them, for comparison: bytes in the file's own type, or texts, however long they may be.
struct StoredValues {
  std::string type;  ///< as Hdf5Entry says it, with the byte order or size where they are not the usual ones
  Shape64 shape;
  std::vector<std::byte> bytes;
  std::vector<std::string> texts;
};

/// A group (the root, "/", among them) or a dataset, with its attributes by name.
struct Hdf5Object {
  std::string name;
  bool is_dataset = false;
  std::map<std::string, StoredValues> attributes;
};

/// An HDF5 file, move only. Names are full paths; groups between are made as needed. Scalars: double, int32, int64,
/// uint64, uint8, stored little-endian. All members throw InputError or Error naming file, dataset and remedy.
class Hdf5File {
 public:
  /// Opens an existing file for reading, once its seal was found to fit its bytes. One without a seal is copied by a
  /// child process with limits on time and memory, and the copy is opened: whatever is wrong with it, this process
  /// goes on. InputError: missing, not HDF5, damaged. Error: no memory or process for the child.
  static Hdf5File open(const std::string& path);
  /// Opens bytes that a checksum vouches for, as image() gives them, for reading; `path` serves the messages only.
  /// InputError: not HDF5.
  static Hdf5File from_image(const std::string& path, std::span<const std::byte> bytes);
  /// An empty file in memory; `path` serves the messages only.
  static Hdf5File in_memory(const std::string& path);

  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&& other) noexcept;
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  ~Hdf5File();

  const std::string& path() const { return path_; }
  /// A checksum vouches for its bytes. False: opened without a seal, or made in memory.
  bool sealed() const { return sealed_; }

  /// Writes values, row-major, of the given shape, with the attribute `units`; in chunks of at most `chunk_rows` of the
  /// outermost extent, or (0) in one piece.
  template <class Scalar>
  void write(const std::string& name, std::span<const Scalar> values, const Shape64& shape, const std::string& units,
             std::uint64_t chunk_rows = 0);
  void write_text(const std::string& name, const std::vector<std::string>& values, const Shape64& shape);

  /// Reads a dataset whole, row-major. InputError if it is missing, of another kind (text for numbers) or does not
  /// convert to Scalar without loss of kind (floating for integer).
  template <class Scalar>
  std::vector<Scalar> read(const std::string& name) const;
  std::vector<std::string> read_text(const std::string& name) const;

  bool has(const std::string& name) const;
  Shape64 shape(const std::string& name) const;

  /// Text attributes of the file itself (of its root group).
  void set_attribute(const std::string& name, const std::string& value);
  std::string attribute(const std::string& name) const;
  std::vector<std::string> attributes() const;

  /// All datasets, in the order of their names.
  std::vector<Hdf5Entry> entries() const;

  /// All groups and datasets, in the order of their names.
  std::vector<Hdf5Object> objects() const;

  /// A dataset as it is stored. InputError if it is missing or of a type that holds references.
  StoredValues stored(const std::string& name) const;

  /// Names of the members of a group, in order; none if there is no such group.
  std::vector<std::string> groups(const std::string& group) const;

  /// Writes everything that another file holds, dates aside; this one is empty.
  void copy(const Hdf5File& from);

  /// The bytes of the file, without a seal.
  std::vector<std::byte> image() const;

 private:
  Hdf5File(std::string path, std::int64_t id, bool sealed) : path_(std::move(path)), id_(id), sealed_(sealed) {}
  std::string path_;
  std::int64_t id_ = -1;
  bool sealed_ = false;
};

/// Version of the HDF5 library in use, for example "1.10.8".
std::string hdf5_version();

/// Builds a file with `fill` and writes it, sealed, as publish_bytes does (publish.hpp). The same content gives the
/// same bytes.
void publish(const std::string& path, const std::function<void(Hdf5File&)>& fill);

}  // namespace rvelab::io
