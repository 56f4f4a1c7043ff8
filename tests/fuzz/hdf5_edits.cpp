#include "tests/fuzz/hdf5_edits.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "rvelab/io/hdf5/file.hpp"

namespace rvelab::fuzz {
namespace {

using Limits = std::numeric_limits<double>;
constexpr double edge_numbers[] = {0.0,
                                   -0.0,
                                   1.0,
                                   -1.0,
                                   2.0,
                                   0.5,
                                   1e-300,
                                   Limits::denorm_min(),
                                   1e300,
                                   1e80,
                                   -1e80,
                                   1e-160,
                                   1e155,
                                   1e-12,
                                   1e12,
                                   Limits::max(),
                                   -1e300,
                                   Limits::infinity(),
                                   -Limits::infinity(),
                                   Limits::quiet_NaN()};
constexpr std::int64_t edge_integers[] = {0,
                                          1,
                                          -1,
                                          2,
                                          3,
                                          -2,
                                          15,
                                          16,
                                          255,
                                          1 << 20,
                                          (1LL << 31) - 1,
                                          -(1LL << 31),
                                          1LL << 32,
                                          1LL << 62,
                                          std::numeric_limits<std::int64_t>::max(),
                                          std::numeric_limits<std::int64_t>::min()};
const std::string edge_texts[] = {"",
                                  "disc",
                                  "sphere",
                                  "linear",
                                  "hertz_mindlin",
                                  "hertz_stiffness",
                                  "none",
                                  "tsuji",
                                  "consistent",
                                  "1.0",
                                  "1.12",
                                  "2.0",
                                  "3.0",
                                  "-1.-1",
                                  "\xff\xfe",
                                  "a\nb",
                                  "[test",
                                  "rvelab records",
                                  "y",
                                  "rvelab specimen",
                                  std::string("\0x", 2),
                                  std::string(70'000, 'a')};
const std::vector<hid_t>& other_types() {
  static const std::vector<hid_t> types{H5T_IEEE_F32LE, H5T_IEEE_F64BE, H5T_IEEE_F64LE, H5T_STD_I8LE,
                                        H5T_STD_I32LE,  H5T_STD_U64LE,  H5T_STD_I64BE,  H5T_STD_B8LE};
  return types;
}

class Editor {
 public:
  Editor(View image, Choices& choices) : choices_(choices) {
    for (const auto& entry : io::Hdf5File::from_image("edited", image).entries()) names_.push_back(entry.name);
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, 1 << 16, false);
    H5Pset_file_image(access, const_cast<std::byte*>(image.data()), image.size());
    file_ = H5Fopen("edited#", H5F_ACC_RDWR, access);
    H5Pclose(access);
    if (file_ < 0) throw std::logic_error("the file to be changed is no HDF5");
  }
  Editor(const Editor&) = delete;
  Editor& operator=(const Editor&) = delete;
  ~Editor() { H5Fclose(file_); }

  void edit() {
    if (names_.empty()) return;
    const std::string& name = choices_.among(names_);
    if (H5Lexists(file_, name.c_str(), H5P_DEFAULT) <= 0) return;
    switch (choices_.below(14)) {
      case 0:
      case 1:
      case 2:
        return change_values(name, false);
      case 3:
        return change_values(name, true);
      case 4:
        return reshape(name);
      case 5:
        return remake(name, choices_.among(other_types()), extents_of(name), false);
      case 6:
        return retext(name);
      case 7:
        H5Ldelete(file_, name.c_str(), H5P_DEFAULT);
        return;
      case 8:
        return exchange(name, choices_.among(names_));
      case 10:
        return rearrange("/contacts/");
      case 11:
        return rearrange("/grains/");
      case 12:
        return rearrange("/bonds/");
      case 13:
        return rearrange("/bridges/");
      default:
        return change_attribute(choices_.below(2) == 0 ? "format_version" : "format");
    }
  }

  Bytes image() const {
    H5Fflush(file_, H5F_SCOPE_GLOBAL);
    Bytes bytes(static_cast<std::size_t>(H5Fget_file_image(file_, nullptr, 0)));
    H5Fget_file_image(file_, bytes.data(), bytes.size());
    return bytes;
  }

 private:
  std::vector<hsize_t> extents_of(const std::string& name) const {
    const hid_t dataset = H5Dopen2(file_, name.c_str(), H5P_DEFAULT), space = H5Dget_space(dataset);
    std::vector<hsize_t> extents(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    if (!extents.empty()) H5Sget_simple_extent_dims(space, extents.data(), nullptr);
    H5Sclose(space);
    H5Dclose(dataset);
    return extents;
  }

  void change_values(const std::string& name, bool all) {
    const hid_t dataset = H5Dopen2(file_, name.c_str(), H5P_DEFAULT), type = H5Dget_type(dataset);
    const H5T_class_t kind = H5Tget_class(type);
    H5Tclose(type);
    if (kind == H5T_FLOAT) overwrite(dataset, H5T_NATIVE_DOUBLE, choices_.among(edge_numbers), name, all);
    if (kind == H5T_INTEGER) overwrite(dataset, H5T_NATIVE_INT64, choices_.among(edge_integers), name, all);
    H5Dclose(dataset);
    if (kind == H5T_STRING) retext(name);
  }

  template <class Value>
  void overwrite(hid_t dataset, hid_t type, Value value, const std::string& name, bool all) {
    std::size_t count = 1;
    for (const auto extent : extents_of(name)) count *= extent;
    if (count > 65536) return;  // said to be so large by an edit before; each of its chunks would be made
    std::vector<Value> values(count);
    if (count == 0 || H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return;
    if (all) values.assign(count, value);
    values[choices_.below(std::min<std::size_t>(count, 65536))] = value;
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }

  void reshape(const std::string& name) {
    std::vector<hsize_t> extents = extents_of(name);
    const std::size_t way = choices_.below(7);
    if (way == 0) extents.clear();
    if (way == 1) extents.push_back(1);
    if (way == 2) extents.assign(1, 0);
    if (extents.empty()) extents.push_back(2);
    if (way == 3) ++extents.front();
    if (way == 4 && extents.front() > 0) --extents.front();
    if (way == 5) extents.back() += 2;
    if (way == 6) extents.front() = hsize_t{1} << (20 + choices_.below(40));  // in chunks, none of which is there
    const hid_t dataset = H5Dopen2(file_, name.c_str(), H5P_DEFAULT), type = H5Dget_type(dataset);
    H5Dclose(dataset);
    remake(name, type, extents, way == 6);
    H5Tclose(type);
  }

  void remake(const std::string& name, hid_t type, const std::vector<hsize_t>& extents, bool chunked) {
    const hid_t space = extents.empty() ? H5Screate(H5S_SCALAR)
                                        : H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    if (chunked) {
      const std::vector<hsize_t> chunk(extents.size(), 1);
      H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
    }
    H5Ldelete(file_, name.c_str(), H5P_DEFAULT);
    const hid_t made = H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    if (made >= 0) H5Dclose(made);
    H5Pclose(creation);
    H5Sclose(space);
  }

  void retext(const std::string& name) {
    const std::string& text = choices_.among(edge_texts);
    const std::vector<hsize_t> extents = extents_of(name);
    const hid_t type = text_type(text);
    remake(name, type, extents, false);
    std::size_t count = 1;
    for (const auto extent : extents) count = std::min<std::size_t>(count, 65537) * std::min<hsize_t>(extent, 65537);
    std::string letters;
    const bool written = !text.empty() && count <= 65536 && count * text.size() <= 1'000'000;
    for (std::size_t k = 0; written && k < count; ++k) letters += text;
    const hid_t dataset = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    if (dataset >= 0 && written) H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, letters.data());
    if (dataset >= 0) H5Dclose(dataset);
    H5Tclose(type);
  }

  static hid_t text_type(const std::string& text) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, std::max<std::size_t>(1, text.size()));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    return type;
  }

  /// Writes one row of a table over another in all of its columns, or lets the two change places.
  void rearrange(const std::string& table) {
    const std::size_t a = choices_.below(65536), b = choices_.below(65536);
    const bool swapped = choices_.below(2) == 0;
    for (const std::string& name : names_) {
      const std::size_t at = name.find(table);
      if (at == std::string::npos || H5Lexists(file_, name.c_str(), H5P_DEFAULT) <= 0) continue;
      const std::vector<hsize_t> extents = extents_of(name);
      std::size_t count = 1;
      for (const auto extent : extents) count *= extent;
      if (extents.empty() || count == 0 || count > 65536) continue;
      const hid_t dataset = H5Dopen2(file_, name.c_str(), H5P_DEFAULT), type = H5Dget_type(dataset);
      const std::size_t width = H5Tget_size(type) * (count / extents[0]);
      std::vector<std::byte> rows(width * extents[0]);
      if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0) {
        std::byte *from = rows.data() + a % extents[0] * width, *to = rows.data() + b % extents[0] * width;
        if (from != to) swapped ? void(std::swap_ranges(from, from + width, to)) : void(std::copy_n(from, width, to));
        H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
      }
      H5Tclose(type);
      H5Dclose(dataset);
    }
  }

  void exchange(const std::string& a, const std::string& b) {
    if (a == b || H5Lexists(file_, b.c_str(), H5P_DEFAULT) <= 0) return;
    H5Lmove(file_, a.c_str(), file_, "/exchanged", H5P_DEFAULT, H5P_DEFAULT);
    H5Lmove(file_, b.c_str(), file_, a.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    H5Lmove(file_, "/exchanged", file_, b.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }

  void change_attribute(const char* name) {
    if (H5Aexists(file_, name) > 0) H5Adelete(file_, name);
    const std::string& text = choices_.among(edge_texts);
    if (text.empty()) return;
    const hid_t type = text_type(text), space = H5Screate(H5S_SCALAR);
    const hid_t made = H5Acreate2(file_, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    if (made >= 0) H5Awrite(made, type, text.data());
    if (made >= 0) H5Aclose(made);
    H5Sclose(space);
    H5Tclose(type);
  }

  Choices& choices_;
  hid_t file_ = -1;
  std::vector<std::string> names_;
};

}  // namespace

Bytes edited(View image, Choices& choices) {
  Editor editor(image, choices);
  for (int k = 0; k < 4 && !choices.done(); ++k) editor.edit();
  return editor.image();
}

}  // namespace rvelab::fuzz
