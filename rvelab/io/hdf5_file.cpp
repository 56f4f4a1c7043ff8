#include "rvelab/io/hdf5_file.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <type_traits>
#include <utility>

#include "rvelab/error.hpp"

namespace rvelab {
namespace {

/// An HDF5 identifier that is closed by the function of its kind.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 prints its error stack by default; here it goes into exceptions.
void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

/// The innermost message of HDF5's error stack.
std::string hdf5_reason() {
  std::string reason;
  const auto first = [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
    auto& reason = *static_cast<std::string*>(text);
    if (reason.empty() && error->desc != nullptr) reason = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first, &reason);
  return reason.empty() ? "no reason given" : reason;
}

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

// Types and property lists that never change are made once: making them for each dataset was a seventh of the time that
// a file takes.

hid_t text_type() {
  static const Handle type = [] {
    const hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, H5T_VARIABLE);
    H5Tset_cset(text, H5T_CSET_UTF8);
    return Handle(text, H5Tclose);
  }();
  return type;
}

/// Links whose groups are made as needed.
hid_t link_creation() {
  static const Handle list = [] {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    return Handle(links, H5Pclose);
  }();
  return list;
}

/// Datasets in one piece, without dates: the same content gives the same bytes.
hid_t dataset_creation() {
  static const Handle list = [] {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(creation, 0);
    return Handle(creation, H5Pclose);
  }();
  return list;
}

Handle space_of(const Shape64& shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  const std::vector<hsize_t> extents(shape.begin(), shape.end());
  return {H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose};
}

Shape64 shape_of(hid_t space) {
  Shape64 shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  std::vector<hsize_t> extents(shape.size());
  if (!shape.empty()) H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  shape.assign(extents.begin(), extents.end());
  return shape;
}

/// Transfer of text. HDF5 converts it through a buffer that it clears for each call, by default 1 MiB: most of the time
/// that a specimen of 400 discs took to be written (15 ms; 6 ms with this one).
hid_t text_transfer() {
  static const Handle list = [] {
    const hid_t transfer = H5Pcreate(H5P_DATASET_XFER);
    H5Pset_buffer(transfer, 1 << 14, nullptr, nullptr);
    return Handle(transfer, H5Pclose);
  }();
  return list;
}

std::uint64_t count(const Shape64& shape) {
  std::uint64_t product = 1;
  for (const auto extent : shape) product *= extent;
  return product;
}

std::string type_name(hid_t type) {
  const auto size = H5Tget_size(type);
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return size == 8 ? "float64" : "float32";
    case H5T_INTEGER:
      return (H5Tget_sign(type) == H5T_SGN_NONE ? "uint" : "int") + std::to_string(8 * size);
    case H5T_STRING:
      return "text";
    default:
      return "other";
  }
}

/// The same with what type_name leaves open, so that equal names mean equal bytes for equal values.
std::string exact_type_name(hid_t type) {
  std::string name = type_name(type);
  if (H5Tis_variable_str(type) > 0) return name;
  const bool usual = name.starts_with("float") || name.find("int") != std::string::npos;
  if (!usual) return name + " of " + std::to_string(H5Tget_size(type)) + " bytes";
  return H5Tget_order(type) == H5T_ORDER_BE ? name + " big-endian" : name;
}

/// The values of a dataset or attribute as they are stored. `read(type, buffer)` is H5Dread or H5Aread on it.
template <class Read>
StoredValues stored_values(hid_t type, hid_t space, const std::string& what, Read read) {
  StoredValues values{exact_type_name(type), shape_of(space), {}, {}};
  const auto number = count(values.shape);
  const bool text = H5Tis_variable_str(type) > 0;
  if (!text && (H5Tdetect_class(type, H5T_VLEN) > 0 || H5Tdetect_class(type, H5T_REFERENCE) > 0)) {
    throw InputError(what +
                     " holds references to other places; allowed: numbers and text; it is not rvelab's: leave it out");
  }
  if (number == 0) return values;
  if (!text) {
    values.bytes.resize(number * H5Tget_size(type));
    if (read(type, values.bytes.data()) < 0) throw InputError(what + " cannot be read (" + hdf5_reason() + ")");
    return values;
  }
  const Handle memory(H5Tcopy(type), H5Tclose);
  std::vector<char*> texts(number, nullptr);
  if (read(memory, texts.data()) < 0) throw InputError(what + " cannot be read (" + hdf5_reason() + ")");
  for (const char* each : texts) values.texts.emplace_back(each == nullptr ? "" : each);
  H5Dvlen_reclaim(memory, space, H5P_DEFAULT, texts.data());
  return values;
}

[[noreturn]] void fail_write(const std::string& path, const std::string& name) {
  throw Error(path + ": " + name + " could not be written (" + hdf5_reason() + "); check the memory left");
}

void write_attribute(const std::string& path, hid_t object, const std::string& name, const std::string& value) {
  const hid_t type = text_type();
  const Handle space = space_of({});
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const char* text = value.c_str();
  if (attribute < 0 || H5Awrite(attribute, type, &text) < 0) fail_write(path, "attribute " + name);
}

/// A variable-length text attribute; empty if there is none.
std::string read_attribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return {};
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Handle stored(H5Aget_type(attribute), H5Tclose);
  if (H5Tis_variable_str(stored) <= 0) return {};
  const hid_t type = text_type();
  char* text = nullptr;
  if (H5Aread(attribute, type, &text) < 0 || text == nullptr) return {};
  std::string value = text;
  H5free_memory(text);
  return value;
}

Handle create_dataset(hid_t file, const std::string& path, const std::string& name, hid_t type, hid_t space,
                      std::vector<hsize_t> chunk = {}) {
  const Handle chunked(chunk.empty() ? -1 : H5Pcopy(dataset_creation()), H5Pclose);
  if (chunked >= 0) H5Pset_chunk(chunked, static_cast<int>(chunk.size()), chunk.data());
  const hid_t creation = chunked >= 0 ? static_cast<hid_t>(chunked) : dataset_creation();
  const hid_t dataset = H5Dcreate2(file, name.c_str(), type, space, link_creation(), creation, H5P_DEFAULT);
  if (dataset < 0) fail_write(path, name);
  return {dataset, H5Dclose};
}

Handle open_dataset(hid_t file, const std::string& path, const std::string& name) {
  const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (dataset < 0) {
    throw InputError(path + ": dataset " + name +
                     " is missing; the file is not one of rvelab's or is damaged: write it again");
  }
  return {dataset, H5Dclose};
}

[[noreturn]] void fail_read(const std::string& path, const std::string& name) {
  throw InputError(path + ": dataset " + name + " cannot be read (" + hdf5_reason() +
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

Hdf5File Hdf5File::open(const std::string& path) {
  silence_hdf5();
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(path + ": no such file; give the path of an HDF5 file that rvelab wrote");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(path + ": is not a regular file; give the path of an HDF5 file that rvelab wrote");
  }
  if (const int probe = ::open(path.c_str(), O_RDONLY | O_CLOEXEC); probe >= 0) {
    ::close(probe);
  } else {
    throw InputError(path + ": cannot be opened (" + std::strerror(errno) + "); check the permissions");
  }
  if (H5Fis_hdf5(path.c_str()) <= 0) {
    throw InputError(path +
                     ": is not an HDF5 file; give a file that rvelab wrote (make one with `rvelab import` or "
                     "`rvelab run`)");
  }
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id < 0) {
    throw InputError(path + ": cannot be opened as HDF5 (" + hdf5_reason() +
                     "); the file is truncated or damaged: write or copy it again");
  }
  return {path, id};
}

Hdf5File Hdf5File::from_image(const std::string& path, std::span<const std::byte> bytes) {
  silence_hdf5();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  constexpr std::size_t growth = 1 << 16;
  H5Pset_fapl_core(access, growth, false);
  // HDF5 copies the bytes; it only asks for a pointer that it might write to.
  const bool set = !bytes.empty() && H5Pset_file_image(access, const_cast<std::byte*>(bytes.data()), bytes.size()) >= 0;
  // HDF5 refuses an image by the name of a file that exists.
  const hid_t id = set ? H5Fopen((path + "#part").c_str(), H5F_ACC_RDONLY, access) : -1;
  if (id < 0) throw InputError(path + ": holds a part that is not HDF5 (" + hdf5_reason() + "); it is damaged");
  return {path, id};
}

Hdf5File Hdf5File::in_memory(const std::string& path) {
  silence_hdf5();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  constexpr std::size_t growth = 1 << 18;
  H5Pset_fapl_core(access, growth, false);
  const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  if (id < 0) throw Error(path + ": no HDF5 file could be made in memory (" + hdf5_reason() + ")");
  return {path, id};
}

Hdf5File::Hdf5File(Hdf5File&& other) noexcept : path_(std::move(other.path_)), id_(std::exchange(other.id_, -1)) {}

Hdf5File& Hdf5File::operator=(Hdf5File&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(id_, other.id_);
  return *this;
}

Hdf5File::~Hdf5File() {
  if (id_ >= 0) H5Fclose(id_);
}

template <class Scalar>
void Hdf5File::write(const std::string& name, std::span<const Scalar> values, const Shape64& shape,
                     const std::string& units, std::uint64_t chunk_rows) {
  if (values.size() != count(shape)) throw Error(path_ + ": " + name + ": number of values and shape differ");
  std::vector<hsize_t> chunk;
  if (chunk_rows > 0 && count(shape) > 0 && !shape.empty()) {
    chunk.assign(shape.begin(), shape.end());
    chunk.front() = std::min<hsize_t>(chunk.front(), chunk_rows);
  }
  const Handle dataset = create_dataset(id_, path_, name, stored_type<Scalar>(), space_of(shape), chunk);
  const bool written =
      values.empty() || H5Dwrite(dataset, native_type<Scalar>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  if (!written) fail_write(path_, name);
  write_attribute(path_, dataset, "units", units);
}

void Hdf5File::write_text(const std::string& name, const std::vector<std::string>& values, const Shape64& shape) {
  const hid_t type = text_type();
  const Handle dataset = create_dataset(id_, path_, name, type, space_of(shape));
  std::vector<const char*> texts;
  for (const auto& value : values) texts.push_back(value.c_str());
  if (!texts.empty() && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, text_transfer(), texts.data()) < 0) {
    fail_write(path_, name);
  }
  write_attribute(path_, dataset, "units", "-");
}

template <class Scalar>
std::vector<Scalar> Hdf5File::read(const std::string& name) const {
  const Handle dataset = open_dataset(id_, path_, name);
  const Handle stored(H5Dget_type(dataset), H5Tclose);
  const auto expected = std::is_floating_point_v<Scalar> ? H5T_FLOAT : H5T_INTEGER;
  if (H5Tget_class(stored) != expected) {
    fail_kind(path_, name, type_name(stored), expected == H5T_FLOAT ? "float64" : "an integer");
  }
  const Handle space(H5Dget_space(dataset), H5Sclose);
  std::vector<Scalar> values(count(shape_of(space)));
  const bool done =
      values.empty() || H5Dread(dataset, native_type<Scalar>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  if (!done) fail_read(path_, name);
  return values;
}

std::vector<std::string> Hdf5File::read_text(const std::string& name) const {
  const Handle dataset = open_dataset(id_, path_, name);
  const Handle stored(H5Dget_type(dataset), H5Tclose);
  if (H5Tis_variable_str(stored) <= 0) fail_kind(path_, name, type_name(stored), "text of variable length");
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const hid_t type = text_type();
  std::vector<char*> texts(count(shape_of(space)), nullptr);
  if (!texts.empty() && H5Dread(dataset, type, H5S_ALL, H5S_ALL, text_transfer(), texts.data()) < 0) {
    fail_read(path_, name);
  }
  std::vector<std::string> values;
  for (const char* text : texts) values.emplace_back(text == nullptr ? "" : text);
  if (!texts.empty()) H5Dvlen_reclaim(type, space, H5P_DEFAULT, texts.data());
  return values;
}

bool Hdf5File::has(const std::string& name) const {
  for (auto slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    if (H5Lexists(id_, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(id_, name.c_str(), H5P_DEFAULT) > 0;
}

Shape64 Hdf5File::shape(const std::string& name) const {
  const Handle dataset = open_dataset(id_, path_, name);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  return shape_of(space);
}

void Hdf5File::set_attribute(const std::string& name, const std::string& value) {
  const Handle root(H5Oopen(id_, "/", H5P_DEFAULT), H5Oclose);
  write_attribute(path_, root, name, value);
}

std::string Hdf5File::attribute(const std::string& name) const {
  const Handle root(H5Oopen(id_, "/", H5P_DEFAULT), H5Oclose);
  return read_attribute(root, name);
}

std::vector<std::string> Hdf5File::attributes() const {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  const Handle root(H5Oopen(id_, "/", H5P_DEFAULT), H5Oclose);
  hsize_t position = 0;
  H5Aiterate2(root, H5_INDEX_NAME, H5_ITER_INC, &position, collect, &names);
  return names;
}

std::vector<Hdf5Entry> Hdf5File::entries() const {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  H5Ovisit2(id_, H5_INDEX_NAME, H5_ITER_INC, collect, &names, H5O_INFO_BASIC);
  std::vector<Hdf5Entry> found;
  for (const auto& name : names) {
    const Handle dataset = open_dataset(id_, path_, "/" + name);
    const Handle type(H5Dget_type(dataset), H5Tclose);
    const Handle space(H5Dget_space(dataset), H5Sclose);
    found.push_back({"/" + name, type_name(type), shape_of(space), read_attribute(dataset, "units")});
  }
  return found;
}

std::vector<Hdf5Object> Hdf5File::objects() const {
  std::vector<Hdf5Object> found;
  const auto collect = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    const std::string path = std::string(name) == "." ? "/" : "/" + std::string(name);
    if (info->type == H5O_TYPE_DATASET || info->type == H5O_TYPE_GROUP) {
      static_cast<std::vector<Hdf5Object>*>(list)->push_back({path, info->type == H5O_TYPE_DATASET, {}});
    }
    return 0;
  };
  H5Ovisit2(id_, H5_INDEX_NAME, H5_ITER_INC, collect, &found, H5O_INFO_BASIC);
  const auto name_attribute = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  for (auto& object : found) {
    const Handle opened(H5Oopen(id_, object.name.c_str(), H5P_DEFAULT), H5Oclose);
    std::vector<std::string> names;
    hsize_t position = 0;
    H5Aiterate2(opened, H5_INDEX_NAME, H5_ITER_INC, &position, name_attribute, &names);
    for (const auto& name : names) {
      const Handle attribute(H5Aopen(opened, name.c_str(), H5P_DEFAULT), H5Aclose);
      const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
      object.attributes[name] =
          stored_values(type, space, path_ + ": attribute " + name + " of " + object.name,
                        [&](hid_t memory, void* buffer) { return H5Aread(attribute, memory, buffer); });
    }
  }
  return found;
}

StoredValues Hdf5File::stored(const std::string& name) const {
  const Handle dataset = open_dataset(id_, path_, name);
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  return stored_values(type, space, path_ + ": dataset " + name, [&](hid_t memory, void* buffer) {
    return H5Dread(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer);
  });
}

std::vector<std::string> Hdf5File::groups(const std::string& group) const {
  std::vector<std::string> names;
  if (!has(group)) return names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  hsize_t position = 0;
  const Handle opened(H5Gopen2(id_, group.c_str(), H5P_DEFAULT), H5Gclose);
  H5Literate(opened, H5_INDEX_NAME, H5_ITER_INC, &position, collect, &names);
  return names;
}

std::vector<std::byte> Hdf5File::image() const {
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

}  // namespace rvelab
