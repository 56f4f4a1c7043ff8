#include "rvelab/io/hdf5_raw.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>

#include "rvelab/error.hpp"

namespace rvelab::io::raw {

void expect_memory(std::uint64_t bytes) {
  constexpr std::uint64_t besides = 8 << 20;  // its caches and conversion buffers, a MiB each
  void* const found = std::malloc(bytes + besides);
  if (found == nullptr) throw std::bad_alloc();
  std::free(found);
}

void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

std::string reason() {
  Shown<std::string> reasons;
  const auto each = [](unsigned, const H5E_error2_t* error, void* list) -> herr_t {
    return error->desc == nullptr ? 0 : static_cast<Shown<std::string>*>(list)->add(error->desc);
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, each, &reasons);
  for (auto& reason : reasons.taken()) {
    if (!reason.empty()) return std::move(reason);
  }
  return "no reason given";
}

// Property lists that never change are made once: making them for each dataset was a seventh of the time that a file
// takes.

hid_t link_creation() {
  static const Handle list = [] {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    return Handle(links, H5Pclose);
  }();
  return list;
}

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
  const int dimensions = H5Sget_simple_extent_ndims(space);
  if (H5Sget_simple_extent_type(space) == H5S_NULL) return {0};
  Shape64 shape(static_cast<std::size_t>(std::max(dimensions, 0)));
  std::vector<hsize_t> extents(shape.size());
  if (!shape.empty()) H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  shape.assign(extents.begin(), extents.end());
  return shape;
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
  if (name == "text") return name;
  const bool usual = name.starts_with("float") || name.find("int") != std::string::npos;
  if (!usual) return name + " of " + std::to_string(H5Tget_size(type)) + " bytes";
  return H5Tget_order(type) == H5T_ORDER_BE ? name + " big-endian" : name;
}

PaddedTexts::PaddedTexts(const std::vector<std::string>& texts, const Shape64& shape)
    : bytes(1), type(H5Tcopy(H5T_C_S1), H5Tclose), space(space_of(shape)) {
  for (const auto& text : texts) bytes = std::max(bytes, text.size());
  H5Tset_size(type, bytes);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  letters.resize(texts.size() * bytes);
  for (std::size_t k = 0; k < texts.size(); ++k) {
    std::copy(texts[k].begin(), texts[k].end(), letters.begin() + static_cast<std::ptrdiff_t>(k * bytes));
  }
}

std::vector<std::string> unpadded(const std::vector<char>& letters, std::size_t bytes) {
  std::vector<std::string> texts;
  for (std::size_t begin = 0; begin < letters.size(); begin += bytes) {
    std::size_t length = bytes;
    while (length > 0 && letters[begin + length - 1] == '\0') --length;
    texts.emplace_back(letters.data() + begin, length);
  }
  return texts;
}

std::vector<std::string> taken_texts(hid_t memory, hid_t space, std::vector<char*>& texts) {
  std::vector<std::string> taken;
  for (const char* text : texts) taken.emplace_back(text == nullptr ? "" : text);
  H5Dvlen_reclaim(memory, space, H5P_DEFAULT, texts.data());
  return taken;
}

void refuse_references(const std::string& what) {
  throw InputError(what +
                   " holds references to other places; allowed: numbers and text; it is not rvelab's: leave it out");
}

void refuse_unreadable(const std::string& what) {
  throw InputError(what + " cannot be read (" + reason() + "); the file is damaged: write it again");
}

bool write_attribute(hid_t object, const std::string& name, const std::string& value) {
  const PaddedTexts text({value}, {});
  const Handle attribute(H5Acreate2(object, name.c_str(), text.type, text.space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute >= 0 && H5Awrite(attribute, text.type, text.letters.data()) >= 0;
}

std::string read_attribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return {};
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING) return {};
  const auto values = stored_values(type, space, "attribute " + name,
                                    [&](hid_t memory, void* buffer) { return H5Aread(attribute, memory, buffer); });
  return values.texts.empty() ? std::string() : values.texts.front();
}

std::vector<std::string> attribute_names(hid_t object) {
  Shown<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    return static_cast<Shown<std::string>*>(list)->add(name);
  };
  hsize_t position = 0;
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, &position, collect, &names);
  return names.taken();
}

namespace {

/// Datasets are stored whole. One in chunks that are not there would be read as zeros, as many as it says.
bool stored_whole(hid_t dataset) {
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  const Shape64 shape = shape_of(space);
  if (std::find(shape.begin(), shape.end(), 0u) != shape.end()) return true;
  std::uint64_t left = H5Dget_storage_size(dataset) / std::max<std::uint64_t>(1, H5Tget_size(type));
  for (const auto extent : shape) left /= extent;
  return left > 0;
}

}  // namespace

Handle open_dataset(hid_t file, const std::string& path, const std::string& name) {
  Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (dataset < 0) {
    throw InputError(path + ": dataset " + name +
                     " is missing; the file is not one of rvelab's or is damaged: write it again");
  }
  if (!stored_whole(dataset)) {
    throw InputError(path + ": dataset " + name +
                     " says that it is larger than what is stored of it; the file is damaged: write it again");
  }
  return dataset;
}

}  // namespace rvelab::io::raw
