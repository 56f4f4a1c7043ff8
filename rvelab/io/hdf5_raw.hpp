// What the files that speak to HDF5's C library share: identifiers that close themselves, types, texts and messages.
// No file but hdf5_*.cpp includes this.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "rvelab/io/hdf5_file.hpp"

namespace rvelab::io::raw {

/// An HDF5 identifier that is closed by the function of its kind.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
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

/// std::bad_alloc unless so many bytes are to be had, and some more for what HDF5 needs besides. HDF5's library crashes
/// where it gets no memory: it is asked for before, here.
void expect_memory(std::uint64_t bytes);

/// HDF5 prints its error stack by default; here it goes into exceptions.
void silence();

/// The innermost message of HDF5's error stack.
std::string reason();

/// Links whose groups are made as needed.
hid_t link_creation();
/// Datasets in one piece, without dates: the same content gives the same bytes.
hid_t dataset_creation();

Handle space_of(const Shape64& shape);
Shape64 shape_of(hid_t space);
std::uint64_t count(const Shape64& shape);

/// "float64", "int32", "text" and so on.
std::string type_name(hid_t type);

/// What HDF5 shows one by one to a function of ours. No exception may pass through its library: it would be left open.
template <class Item>
class Shown {
 public:
  template <class... Parts>
  herr_t add(const Parts&... parts) noexcept try {
    items_.emplace_back(parts...);
    return 0;
  } catch (const std::bad_alloc&) {
    no_memory_ = true;
    return -1;
  }
  std::vector<Item> taken() {
    if (no_memory_) throw std::bad_alloc();
    return std::move(items_);
  }

 private:
  std::vector<Item> items_;
  bool no_memory_ = false;
};

/// Values of a dataset or attribute. `read(memory_type, buffer)` is H5Dread or H5Aread on it, `what` begins a message.
/// InputError: of a type that holds references, or not readable.
template <class Read>
StoredValues stored_values(hid_t type, hid_t space, const std::string& what, Read read);

/// Texts as they are stored: with a fixed number of bytes, as many as the longest of them takes, UTF-8, the rest NUL.
/// Text of variable length would stand behind addresses in the file, which a damaged one sends anywhere.
struct PaddedTexts {
  PaddedTexts(const std::vector<std::string>& texts, const Shape64& shape);
  std::size_t bytes;  ///< of one; HDF5 has no text of none
  Handle type, space;
  std::vector<char> letters;
};

bool write_attribute(hid_t object, const std::string& name, const std::string& value);
/// A text attribute; empty if there is none.
std::string read_attribute(hid_t object, const std::string& name);
/// Names of the attributes of an object.
std::vector<std::string> attribute_names(hid_t object);

/// InputError: it is missing, or says that it is larger than what is stored of it.
Handle open_dataset(hid_t file, const std::string& path, const std::string& name);

/// Writes every group, dataset and attribute of one file to another, which is empty; its text in fixed lengths.
/// InputError if a part cannot be read, or says that it is larger than `largest` bytes.
void copy_contents(hid_t from, hid_t to, const std::string& path, std::uint64_t largest);

// What stored_values needs.
std::string exact_type_name(hid_t type);
std::vector<std::string> unpadded(const std::vector<char>& letters, std::size_t bytes);
std::vector<std::string> taken_texts(hid_t memory, hid_t space, std::vector<char*>& texts);
[[noreturn]] void refuse_references(const std::string& what);
[[noreturn]] void refuse_unreadable(const std::string& what);

template <class Read>
StoredValues stored_values(hid_t type, hid_t space, const std::string& what, Read read) {
  StoredValues values{exact_type_name(type), shape_of(space), {}, {}};
  const auto number = count(values.shape);
  const bool variable = H5Tis_variable_str(type) > 0;
  if (!variable && (H5Tdetect_class(type, H5T_VLEN) > 0 || H5Tdetect_class(type, H5T_REFERENCE) > 0)) {
    refuse_references(what);
  }
  if (number == 0) return values;
  const std::size_t size = H5Tget_size(type);
  if (variable) {  // files and journals of versions before 1.4
    const Handle memory(H5Tcopy(type), H5Tclose);
    std::vector<char*> texts(number, nullptr);
    if (read(memory, texts.data()) < 0) refuse_unreadable(what);
    values.texts = taken_texts(memory, space, texts);
  } else if (H5Tget_class(type) == H5T_STRING) {
    std::vector<char> letters(number * size);
    if (read(type, letters.data()) < 0) refuse_unreadable(what);
    values.texts = unpadded(letters, size);
  } else {
    values.bytes.resize(number * size);
    if (read(type, values.bytes.data()) < 0) refuse_unreadable(what);
  }
  return values;
}

}  // namespace rvelab::io::raw
