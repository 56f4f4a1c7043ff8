#include "rvelab/io/hdf5_file.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5_raw.hpp"

namespace rvelab::io {

using raw::Handle;

namespace {

template <class Scalar>
hid_t native_type() {
  if constexpr (std::is_same_v<Scalar, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<Scalar, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<Scalar, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<Scalar, std::uint64_t>) return H5T_NATIVE_UINT64;
  if constexpr (std::is_same_v<Scalar, std::uint8_t>) return H5T_NATIVE_UINT8;
}

template <class Scalar>
hid_t stored_type() {
  if constexpr (std::is_same_v<Scalar, double>) return H5T_IEEE_F64LE;
  if constexpr (std::is_same_v<Scalar, std::int32_t>) return H5T_STD_I32LE;
  if constexpr (std::is_same_v<Scalar, std::int64_t>) return H5T_STD_I64LE;
  if constexpr (std::is_same_v<Scalar, std::uint64_t>) return H5T_STD_U64LE;
  if constexpr (std::is_same_v<Scalar, std::uint8_t>) return H5T_STD_U8LE;
}

[[noreturn]] void fail_write(const std::string& path, const std::string& name) {
  throw Error(path + ": " + name + " could not be written (" + raw::reason() + "); check the memory left");
}

/// Memory for a file in memory to grow by so many bytes: it is copied to a larger place.
void expect_room(hid_t file, std::uint64_t bytes) {
  hsize_t size = 0;
  H5Fget_filesize(file, &size);
  raw::expect_memory(size + 2 * bytes);
}

Handle create_dataset(hid_t file, const std::string& path, const std::string& name, hid_t type, hid_t space,
                      std::vector<hsize_t> chunk = {}) {
  const Handle chunked(chunk.empty() ? -1 : H5Pcopy(raw::dataset_creation()), H5Pclose);
  if (chunked >= 0) H5Pset_chunk(chunked, static_cast<int>(chunk.size()), chunk.data());
  const hid_t creation = chunked >= 0 ? static_cast<hid_t>(chunked) : raw::dataset_creation();
  const hid_t dataset = H5Dcreate2(file, name.c_str(), type, space, raw::link_creation(), creation, H5P_DEFAULT);
  if (dataset < 0) fail_write(path, name);
  return {dataset, H5Dclose};
}

[[noreturn]] void fail_read(const std::string& path, const std::string& name) {
  throw InputError(path + ": dataset " + name + " cannot be read (" + raw::reason() +
                   "); the file is damaged: write it again");
}

[[noreturn]] void fail_kind(const std::string& path, const std::string& name, const std::string& found,
                            const std::string& allowed) {
  throw InputError(path + ": dataset " + name + " has the type " + found + "; allowed: " + allowed +
                   "; the file is not one of rvelab's: write it again");
}

}  // namespace

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release);
}

Hdf5File Hdf5File::from_image(const std::string& path, std::span<const std::byte> bytes) {
  raw::silence();
  raw::expect_memory(3 * bytes.size());  // it copies an image twice
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  constexpr std::size_t growth = 1 << 16;
  H5Pset_fapl_core(access, growth, false);
  // HDF5 copies the bytes; it only asks for a pointer that it might write to.
  const bool set = !bytes.empty() && H5Pset_file_image(access, const_cast<std::byte*>(bytes.data()), bytes.size()) >= 0;
  // HDF5 refuses an image by the name of a file that exists.
  const hid_t id = set ? H5Fopen((path + "#part").c_str(), H5F_ACC_RDONLY, access) : -1;
  if (id < 0) throw InputError(path + ": holds a part that is not HDF5 (" + raw::reason() + "); it is damaged");
  return {path, id, true};
}

Hdf5File Hdf5File::in_memory(const std::string& path) {
  raw::silence();
  raw::expect_memory(0);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  constexpr std::size_t growth = 1 << 18;
  H5Pset_fapl_core(access, growth, false);
  const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  if (id < 0) throw Error(path + ": no HDF5 file could be made in memory (" + raw::reason() + ")");
  return {path, id, false};
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept
    : path_(std::move(other.path_)), id_(std::exchange(other.id_, -1)), sealed_(other.sealed_) {}

Hdf5File& Hdf5File::operator=(Hdf5File&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(id_, other.id_);
  std::swap(sealed_, other.sealed_);
  return *this;
}

Hdf5File::~Hdf5File() {
  if (id_ >= 0) H5Fclose(id_);
}

template <class Scalar>
void Hdf5File::write(const std::string& name, std::span<const Scalar> values, const Shape64& shape,
                     const std::string& units, std::uint64_t chunk_rows) {
  if (values.size() != raw::count(shape)) throw Error(path_ + ": " + name + ": number of values and shape differ");
  expect_room(id_, values.size_bytes());
  std::vector<hsize_t> chunk;
  if (chunk_rows > 0 && raw::count(shape) > 0 && !shape.empty()) {
    chunk.assign(shape.begin(), shape.end());
    chunk.front() = std::min<hsize_t>(chunk.front(), chunk_rows);
  }
  const Handle dataset = create_dataset(id_, path_, name, stored_type<Scalar>(), raw::space_of(shape), chunk);
  const bool written =
      values.empty() || H5Dwrite(dataset, native_type<Scalar>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  if (!written) fail_write(path_, name);
  if (!raw::write_attribute(dataset, "units", units)) fail_write(path_, name);
}

void Hdf5File::write_text(const std::string& name, const std::vector<std::string>& values, const Shape64& shape) {
  const raw::PaddedTexts texts(values, shape);
  expect_room(id_, texts.letters.size());
  const Handle dataset = create_dataset(id_, path_, name, texts.type, texts.space);
  const bool written =
      values.empty() || H5Dwrite(dataset, texts.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.letters.data()) >= 0;
  if (!written || !raw::write_attribute(dataset, "units", "-")) fail_write(path_, name);
}

template <class Scalar>
std::vector<Scalar> Hdf5File::read(const std::string& name) const {
  const Handle dataset = raw::open_dataset(id_, path_, name);
  const Handle stored(H5Dget_type(dataset), H5Tclose);
  const auto expected = std::is_floating_point_v<Scalar> ? H5T_FLOAT : H5T_INTEGER;
  if (H5Tget_class(stored) != expected) {
    fail_kind(path_, name, raw::type_name(stored), expected == H5T_FLOAT ? "float64" : "an integer");
  }
  const Handle space(H5Dget_space(dataset), H5Sclose);
  std::vector<Scalar> values(raw::count(raw::shape_of(space)));
  raw::expect_memory(0);
  const bool done =
      values.empty() || H5Dread(dataset, native_type<Scalar>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  if (!done) fail_read(path_, name);
  return values;
}

std::vector<std::string> Hdf5File::read_text(const std::string& name) const {
  StoredValues values = stored(name);
  if (values.type != "text") fail_kind(path_, name, values.type, "text");
  return std::move(values.texts);
}

bool Hdf5File::has(const std::string& name) const {
  for (auto slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    if (H5Lexists(id_, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(id_, name.c_str(), H5P_DEFAULT) > 0;
}

Shape64 Hdf5File::shape(const std::string& name) const {
  const Handle dataset = raw::open_dataset(id_, path_, name);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  return raw::shape_of(space);
}

void Hdf5File::set_attribute(const std::string& name, const std::string& value) {
  const Handle root(H5Oopen(id_, "/", H5P_DEFAULT), H5Oclose);
  if (!raw::write_attribute(root, name, value)) fail_write(path_, "attribute " + name);
}

std::string Hdf5File::attribute(const std::string& name) const {
  const Handle root(H5Oopen(id_, "/", H5P_DEFAULT), H5Oclose);
  return raw::read_attribute(root, name);
}

void Hdf5File::copy(const Hdf5File& from) {
  raw::copy_contents(from.id_, id_, from.path_, std::numeric_limits<std::uint64_t>::max());
}

std::vector<std::byte> Hdf5File::image() const {
  expect_room(id_, 0);
  if (H5Fflush(id_, H5F_SCOPE_GLOBAL) < 0) fail_write(path_, "the file");
  const auto size = H5Fget_file_image(id_, nullptr, 0);
  if (size <= 0) fail_write(path_, "the file");
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  if (H5Fget_file_image(id_, bytes.data(), bytes.size()) != size) fail_write(path_, "the file");
  return bytes;
}

template void Hdf5File::write(const std::string&, std::span<const double>, const Shape64&, const std::string&,
                              std::uint64_t);
template void Hdf5File::write(const std::string&, std::span<const std::int32_t>, const Shape64&, const std::string&,
                              std::uint64_t);
template void Hdf5File::write(const std::string&, std::span<const std::int64_t>, const Shape64&, const std::string&,
                              std::uint64_t);
template void Hdf5File::write(const std::string&, std::span<const std::uint64_t>, const Shape64&, const std::string&,
                              std::uint64_t);
template void Hdf5File::write(const std::string&, std::span<const std::uint8_t>, const Shape64&, const std::string&,
                              std::uint64_t);
template std::vector<double> Hdf5File::read(const std::string&) const;
template std::vector<std::int32_t> Hdf5File::read(const std::string&) const;
template std::vector<std::int64_t> Hdf5File::read(const std::string&) const;
template std::vector<std::uint64_t> Hdf5File::read(const std::string&) const;
template std::vector<std::uint8_t> Hdf5File::read(const std::string&) const;

}  // namespace rvelab::io
