// A tree from the bytes of an HDF5 file. Declared in tree.hpp.
#include <algorithm>
#include <set>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/library.hpp"
#include "rvelab/io/hdf5/tree.hpp"

namespace rvelab::io::hdf5 {
namespace {

std::string member(const std::string& group, const std::string& name) {
  return (group == "/" ? group : group + "/") + name;
}

class Reader {
 public:
  Reader(const std::string& path, std::span<const std::byte> file, Tree& tree)
      : path_(path), file_(file), tree_(tree), numbers_(number_types()) {}

  void read() {
    expect_superblock();
    expect_memory(3 * file_.size());  // two copies of its own, and the values
    const Handle access = access_in_memory(file_.size());
    // The library copies them.
    ok(H5Pset_file_image(access, const_cast<std::byte*>(file_.data()), file_.size()));
    const Handle file(ok(H5Fopen(no_file, H5F_ACC_RDONLY, access)), H5Fclose);
    const Handle root(ok(H5Gopen2(file, "/", H5P_DEFAULT)), H5Gclose);
    H5O_info_t info;
    ok(H5Oget_info2(root, &info, H5O_INFO_BASIC));
    seen_.insert(info.addr);
    tree_.objects.clear();
    object(root, "/", 0);
  }

 private:
  [[noreturn]] void damaged(const std::string& what) const {
    throw InputError(path_ + ": is damaged (" + what +
                     "); copy it again from where it was made, or write it again; nothing of it was read");
  }
  [[noreturn]] void refuse(const std::string& object, const std::string& what, const std::string& remedy) const {
    throw InputError(path_ + ": " + object + " " + what + "; " + remedy);
  }
  template <class Result>
  Result ok(Result result) const {
    if (result < 0) damaged(reason());
    return result;
  }

  /// What stands in the first bytes, before the library sees them: version 0, addresses and lengths of 8 bytes, counted
  /// from the start, no block of a driver.
  void expect_superblock() const {
    if (file_.size() < 96) damaged("it is truncated");
    const auto byte = [&](std::size_t at) { return std::to_integer<int>(file_[at]); };
    const auto all = [&](std::size_t at, int value) {
      for (std::size_t k = at; k < at + 8; ++k) {
        if (byte(k) != value) return false;
      }
      return true;
    };
    if (byte(8) != 0 || byte(13) != 8 || byte(14) != 8) {
      throw InputError(path_ + ": is an HDF5 file of another layout (superblock of version " + std::to_string(byte(8)) +
                       "); allowed: 0, with addresses of 8 bytes; write the file with h5py's own settings (libver "
                       "\"earliest\")");
    }
    if (!all(24, 0) || !all(48, 0xff)) damaged("its first block is none");
  }

  void object(hid_t opened, const std::string& name, int depth) {
    Object& made = tree_.objects[name];
    attributes(opened, name, made);
    const H5I_type_t kind = H5Iget_type(opened);
    if (kind == H5I_GROUP) return group(opened, name, depth);
    if (kind != H5I_DATASET) refuse(name, "is neither a group nor a dataset", "it is not rvelab's: leave it out");
    made.dataset = dataset(opened, path_ + ": dataset " + name);
  }

  struct Link {
    std::string name;
    H5L_type_t type;
    haddr_t address;
  };
  /// What the library shows one by one; what is more than the file has room for ends it.
  template <class Item>
  struct List {
    std::vector<Item> items;
    std::size_t most;
    bool no_memory = false;

    template <class... Value>
    herr_t add(Value... value) noexcept {
      try {
        if (items.size() == most) return -1;
        items.push_back({value...});
        return 0;
      } catch (const std::bad_alloc&) {
        no_memory = true;
        return -1;
      }
    }
  };

  template <class Item>
  void shown(const List<Item>& list, herr_t result) const {
    if (list.no_memory) throw std::bad_alloc();
    ok(result);
  }

  void group(hid_t opened, const std::string& name, int depth) {
    List<Link> links{{}, file_.size() / 16};
    const auto add = [](hid_t, const char* link, const H5L_info_t* info, void* list) {
      return static_cast<List<Link>*>(list)->add(link, info->type, info->u.address);
    };
    shown(links, H5Literate(opened, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &links));
    for (const Link& link : links.items) {
      const std::string path = member(name, link.name);
      if (link.type != H5L_TYPE_HARD) refuse_link(opened, path, link);
      if (link.name.empty() || link.name == "." || link.name.find('/') != std::string::npos ||
          tree_.objects.contains(path)) {
        damaged("a name in " + name + " is none, or is there twice");
      }
      if (depth == most_nested) {
        refuse(path, "lies in more than " + std::to_string(most_nested) + " groups in one another",
               "it is not rvelab's: leave it out");
      }
      if (!seen_.insert(link.address).second) {
        refuse(path, "is a second name of an object or of a group that it lies in",
               "allowed: one name for each; leave the second out");
      }
      const Handle next(ok(H5Oopen(opened, link.name.c_str(), H5P_DEFAULT)), H5Oclose);
      object(next, path, depth + 1);
    }
  }

  [[noreturn]] void refuse_link(hid_t group, const std::string& path, const Link& link) const {
    char value[256] = {};
    const char* target = value;
    H5Lget_val(group, link.name.c_str(), value, sizeof value - 1, H5P_DEFAULT);
    const bool soft = link.type == H5L_TYPE_SOFT;
    if (!soft) target = value + 1;  // a byte of flags, the name of the file, NUL, the name in it, NUL
    refuse(path, std::string("is a link to another ") + (soft ? "name" : "file") + " (" + target + ")",
           "allowed: objects of the file itself, each under one name; copy what is meant into its place");
  }

  Values dataset(hid_t opened, const std::string& what) {
    // Before the extents: those of a virtual dataset may be asked of other files.
    const Handle creation(ok(H5Dget_create_plist(opened)), H5Pclose);
    const H5D_layout_t layout = H5Pget_layout(creation);
    if (layout == H5D_VIRTUAL) {
      throw InputError(what + " is a virtual dataset, whose values lie in other places; allowed: values in the file " +
                       "itself; copy them into it");
    }
    if (layout == H5D_CHUNKED) {
      throw InputError(what + (ok(H5Pget_nfilters(creation)) > 0 ? " is compressed or filtered" : " is in chunks") +
                       "; allowed: values in one piece, as they are; write it without chunks and filters");
    }
    if (ok(H5Pget_external_count(creation)) > 0) {
      throw InputError(what + " keeps its values in another file (external storage); allowed: values in the file " +
                       "itself; copy them into it");
    }
    const Handle type(ok(H5Dget_type(opened)), H5Tclose), space(ok(H5Dget_space(opened)), H5Sclose);
    return values(type, space, H5Dget_storage_size(opened), what,
                  [&](void* to) { return H5Dread(opened, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to); });
  }

  void attributes(hid_t opened, const std::string& object, Object& made) {
    struct Name {
      std::string text;
    };
    List<Name> names{{}, file_.size() / 16};
    const auto add = [](hid_t, const char* name, const H5A_info_t*, void* list) {
      return static_cast<List<Name>*>(list)->add(name);
    };
    shown(names, H5Aiterate2(opened, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names));
    for (const auto& [name] : names.items) {
      const std::string what = path_ + ": attribute " + name + " of " + object;
      const Handle attribute(ok(H5Aopen(opened, name.c_str(), H5P_DEFAULT)), H5Aclose);
      const Handle type(ok(H5Aget_type(attribute)), H5Tclose), space(ok(H5Aget_space(attribute)), H5Sclose);
      made.attributes[name] = values(type, space, H5Aget_storage_size(attribute), what,
                                     [&](void* to) { return H5Aread(attribute, type, to); });
    }
  }

  /// `stored`: bytes that the file has of it. Their type in memory is that in the file: nothing is converted.
  template <class ReadTo>
  Values values(hid_t type, hid_t space, hsize_t stored, const std::string& what, ReadTo read_to) {
    Values made{type_of(type, what), shape_of(space, what), {}};
    std::uint64_t bytes = made.type.bytes;
    for (const std::uint64_t extent : made.shape) {
      if (extent > 0 && bytes > file_.size() / extent)
        bytes = file_.size() + 1;
      else
        bytes *= extent;
    }
    if (std::find(made.shape.begin(), made.shape.end(), 0u) != made.shape.end()) return made;
    if (bytes > stored || bytes > file_.size() - given_) {
      throw InputError(what + " says that it is larger than what is stored of it; the file is damaged: write it again");
    }
    given_ += bytes;
    auto& room = tree_.storage.emplace_back(bytes);
    ok(read_to(room.data()));
    made.bytes = room;
    return made;
  }

  Type type_of(hid_t type, const std::string& what) const {
    if (ok(H5Tcommitted(type)) > 0) {
      throw InputError(what + " has a type that lies elsewhere; allowed: a type of its own; write it without named " +
                       "types");
    }
    const H5T_class_t kind = H5Tget_class(type);
    if (kind == H5T_STRING) {
      if (ok(H5Tis_variable_str(type)) == 0) return {Kind::text, std::uint32_t(H5Tget_size(type))};
      throw InputError(what + " holds text of variable length; allowed: of fixed length; write it so (in h5py as " +
                       "numpy.bytes_)");
    }
    if (kind != H5T_INTEGER && kind != H5T_FLOAT) {
      throw InputError(what + " holds values that are neither numbers nor text (such as compounds, enumerations, " +
                       "truth values of h5py); it is not rvelab's: leave it out");
    }
    for (const NumberType& number : numbers_) {
      if (H5Tequal(type, number.id) > 0) return number.type;
    }
    throw InputError(what +
                     " holds numbers of another layout (big-endian, or of odd sizes); allowed: little-endian "
                     "integers of 8, 16, 32 and 64 bits and floating-point numbers of 32 and 64; write them so");
  }

  std::vector<std::uint64_t> shape_of(hid_t space, const std::string& what) const {
    constexpr int most = 8;
    if (H5Sget_simple_extent_type(space) == H5S_NULL) return {0};
    const int dimensions = ok(H5Sget_simple_extent_ndims(space));
    if (dimensions > most) throw InputError(what + " has more than 8 dimensions; it is not rvelab's: leave it out");
    hsize_t extents[most];
    ok(H5Sget_simple_extent_dims(space, extents, nullptr));
    return {extents, extents + dimensions};
  }

  const std::string& path_;
  std::span<const std::byte> file_;
  Tree& tree_;
  std::vector<NumberType> numbers_;
  std::set<haddr_t> seen_;   ///< objects
  std::uint64_t given_ = 0;  ///< bytes of values so far
};

}  // namespace

Tree read(const std::string& path, std::span<const std::byte> file) {
  const Turn turn;
  Tree tree;
  Reader(path, file, tree).read();
  return tree;
}

}  // namespace rvelab::io::hdf5
