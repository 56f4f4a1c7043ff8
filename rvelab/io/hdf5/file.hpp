// An HDF5 file as one small class: typed arrays, text and attributes by name; its errors as rvelab's own.
//
// A file is read whole, its seal is held against its bytes (seal.hpp), and HDF5's library takes these bytes apart in
// memory (tree.hpp). Files are built in memory and written by publish(), so that no HDF5 file is ever open for writing
// on disc and a full disc is one plain error.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "rvelab/io/hdf5/tree.hpp"
#include "rvelab/io/publish.hpp"

namespace rvelab::io {

using Shape64 = std::vector<std::uint64_t>;  ///< extents of an array, outermost first; empty: a scalar

/// "(3, 0, 2)"; "()" for a scalar.
std::string in_words(const Shape64& shape);

/// A dataset as a walk through a file finds it.
struct Hdf5Entry {
  std::string name;   ///< full path, for example "/grains/radius_m"
  std::string type;   ///< float64, int32, int64, uint64, uint8 or text
  Shape64 shape;      ///< empty: a scalar
  std::string units;  ///< its attribute `units`; "1" where it is a pure number, "-" where it is none
};

/// The texts of a dataset or attribute, without what pads them.
std::vector<std::string> texts_in(const hdf5::Values& values);

/// Whether a file may lack its seal: what is sealed anew, or compared and not rvelab's.
enum class Seal { required, if_any };

/// An HDF5 file in memory, move only. Names are full paths; groups between are made as needed. Scalars: double, int32,
/// int64, uint64, uint8. All members throw InputError or Error naming file, dataset and remedy.
class Hdf5File {
 public:
  /// Reads an existing file, once its seal was found to fit its bytes. InputError: missing, no regular file, not HDF5,
  /// damaged, with parts that rvelab does not write (tree.hpp), without the seal that is required.
  static Hdf5File open(const std::string& path, Seal seal = Seal::required);
  /// Reads bytes that a checksum vouches for, as image() gives them; `path` serves the messages only. InputError: not
  /// HDF5.
  static Hdf5File from_image(const std::string& path, std::span<const std::byte> bytes);
  /// An empty file; `path` serves the messages only.
  static Hdf5File in_memory(const std::string& path);

  const std::string& path() const { return path_; }
  /// A checksum vouches for its bytes. False: opened without a seal, or made in memory.
  bool sealed() const { return sealed_; }
  /// InputError: not sealed.
  void expect_seal() const;

  /// Writes values, row-major, of the given shape, with the attribute `units`; "": without it, where names end in
  /// units.
  template <class Scalar>
  void write(const std::string& name, std::span<const Scalar> values, const Shape64& shape,
             const std::string& units = "");
  void write_text(const std::string& name, const std::vector<std::string>& values, const Shape64& shape);

  /// Reads a dataset whole, row-major. InputError if it is missing, of another kind (text for numbers, floating for
  /// integers), or holds an integer that a Scalar does not.
  template <class Scalar>
  std::vector<Scalar> read(const std::string& name) const;
  std::vector<std::string> read_text(const std::string& name) const;

  bool has(const std::string& name) const { return tree_.objects.contains(name); }
  Shape64 shape(const std::string& name) const { return dataset(name).shape; }

  /// Text attributes of the file itself (of its root group).
  void set_attribute(const std::string& name, const std::string& value);
  std::string attribute(const std::string& name) const;
  std::vector<std::string> attributes() const;

  /// All datasets, in the order of their names.
  std::vector<Hdf5Entry> entries() const;

  /// All groups and datasets as they are stored.
  const hdf5::Tree& tree() const { return tree_; }

  /// Names of the members of a group, in order; none if there is no such group.
  std::vector<std::string> groups(const std::string& group) const;

  /// The bytes of the file, without a seal.
  std::vector<std::byte> image() const { return hdf5::write(tree_); }

 private:
  Hdf5File(std::string path, bool sealed) : path_(std::move(path)), sealed_(sealed) {}
  const hdf5::Values& dataset(const std::string& name) const;
  hdf5::Values kept(hdf5::Type type, const Shape64& shape, std::span<const std::byte> bytes);
  hdf5::Values kept(const std::vector<std::string>& texts, const Shape64& shape);
  void put(const std::string& name, hdf5::Values values, const std::string& units);

  std::string path_;
  bool sealed_ = false;
  hdf5::Tree tree_;
};

/// Builds a file with `fill` and writes it, sealed, as publish_bytes does (publish.hpp). The same content gives the
/// same bytes.
void publish(const std::string& path, const std::function<void(Hdf5File&)>& fill);

/// Writes what a file holds to another path, sealed.
void publish(const std::string& path, const Hdf5File& file, Sync sync = Sync::now);

}  // namespace rvelab::io
