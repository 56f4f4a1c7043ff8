// The bytes of an HDF5 file from a tree. Declared in tree.hpp.
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/library.hpp"
#include "rvelab/io/hdf5/tree.hpp"

namespace rvelab::io::hdf5 {
namespace {

/// Objects are made in the order of their names, without times; so equal trees give equal bytes.
class Writer {
 public:
  explicit Writer(const Tree& tree)
      : tree_(tree), numbers_(number_types()), layout_(H5Pcreate(H5P_DATASET_CREATE), H5Pclose) {
    H5Pset_obj_track_times(layout_, false);
    H5Pset_fill_time(layout_, H5D_FILL_TIME_NEVER);
  }

  std::vector<std::byte> made() {
    std::size_t bytes = 4096 + 800 * tree_.objects.size();
    for (const auto& storage : tree_.storage) bytes += storage.size();
    expect_memory(3 * bytes);
    const Handle access = access_in_memory(bytes);
    const Handle file(ok(H5Fcreate(no_file, H5F_ACC_TRUNC, H5P_DEFAULT, access), "/"), H5Fclose);
    for (const auto& [path, object] : tree_.objects) add(file, path, object);
    ok(H5Fflush(file, H5F_SCOPE_LOCAL), "/");
    std::vector<std::byte> image(std::size_t(ok(H5Fget_file_image(file, nullptr, 0), "/")));
    ok(H5Fget_file_image(file, image.data(), image.size()), "/");
    return image;
  }

 private:
  template <class Result>
  static Result ok(Result result, const std::string& object) {
    if (result < 0) throw Error(object + " cannot be stored (" + reason() + ")");
    return result;
  }

  void add(hid_t file, const std::string& path, const Object& object) {
    const auto make = [&]() -> Handle {
      if (path == "/") return {ok(H5Gopen2(file, "/", H5P_DEFAULT), path), H5Gclose};
      if (!object.dataset)
        return {ok(H5Gcreate2(file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), path), H5Gclose};
      const Handle type = type_of(object.dataset->type), space = space_of(object.dataset->shape);
      return {ok(H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, layout_, H5P_DEFAULT), path), H5Dclose};
    };
    const Handle made = make();
    if (object.dataset && !object.dataset->bytes.empty()) {
      const Handle type = type_of(object.dataset->type);
      ok(H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, object.dataset->bytes.data()), path);
    }
    for (const auto& [name, values] : object.attributes) {
      const Handle type = type_of(values.type), space = space_of(values.shape);
      const Handle attribute(ok(H5Acreate2(made, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), path), H5Aclose);
      ok(H5Awrite(attribute, type, values.bytes.data()), path);
    }
  }

  Handle type_of(Type type) const {
    for (const NumberType& number : numbers_) {
      if (number.type == type) return {H5Tcopy(number.id), H5Tclose};
    }
    Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(text, type.bytes);
    H5Tset_strpad(text, H5T_STR_NULLPAD);
    H5Tset_cset(text, H5T_CSET_UTF8);
    return text;
  }

  static Handle space_of(const std::vector<std::uint64_t>& shape) {
    if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
    const std::vector<hsize_t> extents(shape.begin(), shape.end());
    return {H5Screate_simple(int(extents.size()), extents.data(), nullptr), H5Sclose};
  }

  const Tree& tree_;
  std::vector<NumberType> numbers_;
  Handle layout_;
};

}  // namespace

std::vector<std::byte> write(const Tree& tree) {
  const Turn turn;
  return Writer(tree).made();
}

}  // namespace rvelab::io::hdf5
