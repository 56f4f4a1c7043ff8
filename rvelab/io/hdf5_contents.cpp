// What is in a file, whoever wrote it: its objects as they stand, for comparison, and all of them copied.
// Declared in hdf5_file.hpp.
#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5_file.hpp"
#include "rvelab/io/hdf5_raw.hpp"

namespace rvelab::io {

using raw::Handle;

namespace {

StoredValues attribute_values(hid_t object, const std::string& name, const std::string& what) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  return raw::stored_values(type, space, what,
                            [&](hid_t memory, void* buffer) { return H5Aread(attribute, memory, buffer); });
}

StoredValues dataset_values(hid_t dataset, const std::string& what) {
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  return raw::stored_values(type, space, what, [&](hid_t memory, void* buffer) {
    return H5Dread(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer);
  });
}

std::vector<Hdf5Object> objects_of(hid_t file) {
  raw::Shown<std::pair<std::string, bool>> shown;
  const auto collect = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    const bool dataset = info->type == H5O_TYPE_DATASET;
    if (!dataset && info->type != H5O_TYPE_GROUP) return 0;
    return static_cast<raw::Shown<std::pair<std::string, bool>>*>(list)->add(name, dataset);
  };
  const bool whole = H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, collect, &shown, H5O_INFO_BASIC) >= 0;
  std::vector<Hdf5Object> found;
  for (const auto& [name, dataset] : shown.taken()) found.push_back({name == "." ? "/" : "/" + name, dataset, {}});
  if (!whole) found.clear();
  return found;
}

/// Stores values in their own type, text with a fixed length, in what `create(type, space)` makes, by `write(made,
/// type, bytes)`. False: HDF5 could not.
template <class Create, class Write>
bool store(hid_t type, const StoredValues& values, Create create, Write write) {
  const raw::PaddedTexts texts(values.texts, values.shape);
  const bool text = H5Tget_class(type) == H5T_STRING;
  const hid_t stored = text ? hid_t(texts.type) : type;
  const hid_t made = create(stored, texts.space);
  const void* const bytes = text ? static_cast<const void*>(texts.letters.data()) : values.bytes.data();
  return made >= 0 && (raw::count(values.shape) == 0 || write(made, stored, bytes) >= 0);
}

/// Copies objects one by one.
struct Copier {
  hid_t from, to;
  const std::string& path;
  std::uint64_t largest;

  void copy(const Hdf5Object& object) const {
    const Handle source(H5Oopen(from, object.name.c_str(), H5P_DEFAULT), H5Oclose);
    if (source < 0) refuse(object.name, "cannot be read (" + raw::reason() + ")");
    if (!object.is_dataset) {
      const hid_t made = object.name == "/"
                             ? H5Oopen(to, "/", H5P_DEFAULT)
                             : H5Gcreate2(to, object.name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      const Handle group(made, H5Oclose);
      return copy_attributes(source, group, object.name);
    }
    const Handle type(H5Dget_type(source), H5Tclose), space(H5Dget_space(source), H5Sclose);
    expect_size(object.name, type, space);
    const StoredValues values = dataset_values(source, path + ": dataset " + object.name);
    hid_t made = -1;
    const bool stored = store(
        type, values,
        [&](hid_t kind, hid_t extent) {
          return made = H5Dcreate2(to, object.name.c_str(), kind, extent, raw::link_creation(), raw::dataset_creation(),
                                   H5P_DEFAULT);
        },
        [](hid_t dataset, hid_t kind, const void* bytes) {
          return H5Dwrite(dataset, kind, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes);
        });
    const Handle dataset(made, H5Dclose);
    if (!stored) refuse(object.name, "cannot be copied (" + raw::reason() + ")");
    copy_attributes(source, dataset, object.name);
  }

  void copy_attributes(hid_t source, hid_t target, const std::string& name) const {
    for (const auto& each : raw::attribute_names(source)) {
      const Handle attribute(H5Aopen(source, each.c_str(), H5P_DEFAULT), H5Aclose);
      const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
      expect_size(name, type, space);
      const StoredValues values = attribute_values(source, each, path + ": attribute " + each + " of " + name);
      hid_t made = -1;
      const bool stored = store(
          type, values,
          [&](hid_t kind, hid_t extent) {
            return made = H5Acreate2(target, each.c_str(), kind, extent, H5P_DEFAULT, H5P_DEFAULT);
          },
          H5Awrite);
      const Handle closed(made, H5Aclose);
      if (!stored) refuse(name, "has an attribute that cannot be copied (" + raw::reason() + ")");
    }
  }

  void expect_size(const std::string& name, hid_t type, hid_t space) const {
    std::uint64_t bytes = H5Tget_size(type);
    bool fits = bytes > 0;
    for (const auto extent : raw::shape_of(space)) {
      fits = fits && (extent == 0 || bytes <= largest / extent);
      bytes *= extent;
    }
    if (!fits) refuse(name, "says that it is larger than the file");
  }

  [[noreturn]] void refuse(const std::string& name, const std::string& what) const {
    throw InputError(path + ": " + name + " " + what + "; the file is damaged: copy or write it again");
  }
};

}  // namespace

void raw::copy_contents(hid_t from, hid_t to, const std::string& path, std::uint64_t largest) {
  const Copier copier{from, to, path, largest};
  const auto objects = objects_of(from);
  if (objects.empty()) copier.refuse("/", "cannot be listed (" + raw::reason() + ")");
  for (const Hdf5Object& object : objects) copier.copy(object);
}

std::vector<Hdf5Entry> Hdf5File::entries() const {
  std::vector<Hdf5Entry> found;
  for (const auto& object : objects_of(id_)) {
    if (!object.is_dataset) continue;
    const Handle dataset = raw::open_dataset(id_, path_, object.name);
    const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
    found.push_back({object.name, raw::type_name(type), raw::shape_of(space), raw::read_attribute(dataset, "units")});
  }
  return found;
}

std::vector<Hdf5Object> Hdf5File::objects() const {
  auto found = objects_of(id_);
  for (auto& object : found) {
    const Handle opened(H5Oopen(id_, object.name.c_str(), H5P_DEFAULT), H5Oclose);
    for (const auto& name : raw::attribute_names(opened)) {
      object.attributes[name] = attribute_values(opened, name, path_ + ": attribute " + name + " of " + object.name);
    }
  }
  return found;
}

StoredValues Hdf5File::stored(const std::string& name) const {
  const Handle dataset = raw::open_dataset(id_, path_, name);
  return dataset_values(dataset, path_ + ": dataset " + name);
}

std::vector<std::string> Hdf5File::attributes() const {
  const Handle root(H5Oopen(id_, "/", H5P_DEFAULT), H5Oclose);
  return raw::attribute_names(root);
}

std::vector<std::string> Hdf5File::groups(const std::string& group) const {
  if (!has(group)) return {};
  raw::Shown<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    return static_cast<raw::Shown<std::string>*>(list)->add(name);
  };
  hsize_t position = 0;
  const Handle opened(H5Gopen2(id_, group.c_str(), H5P_DEFAULT), H5Gclose);
  H5Literate(opened, H5_INDEX_NAME, H5_ITER_INC, &position, collect, &names);
  return names.taken();
}

}  // namespace rvelab::io
