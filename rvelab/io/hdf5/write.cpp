// The bytes of an HDF5 file. Declared in tree.hpp.
#include <algorithm>
#include <bit>
#include <cstring>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/tree.hpp"

namespace rvelab::io::hdf5 {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian; swap bytes here");

using Bytes = std::vector<std::byte>;

constexpr std::size_t superblock_bytes = 96;
constexpr std::uint16_t leaf_k = 4, node_k = 16;  // names of a leaf and leaves of a node: up to twice as many

template <class... Value>
void put(Bytes& to, Value... values) {
  const auto one = [&](auto value) {
    const std::size_t at = to.size();
    to.resize(at + sizeof value);
    std::memcpy(to.data() + at, &value, sizeof value);
  };
  (one(values), ...);
}

void pad(Bytes& to) { to.resize((to.size() + 7) / 8 * 8); }

void put_text(Bytes& to, const std::string& text) {
  const auto letters = std::as_bytes(std::span(text));
  to.insert(to.end(), letters.begin(), letters.end());
}

void put_space(Bytes& to, const std::vector<std::uint64_t>& shape) {
  put(to, std::uint8_t{1}, std::uint8_t(shape.size()), std::uint16_t{0}, std::uint32_t{0});
  for (const std::uint64_t extent : shape) put(to, extent);
}

void put_type(Bytes& to, Type type) {
  constexpr std::uint8_t version = 1 << 4;
  const auto bits = std::uint16_t(8 * type.bytes);
  if (type.kind == Kind::text) {  // padded with NUL, UTF-8
    put(to, std::uint8_t{version | 3}, std::uint8_t{0x11}, std::uint16_t{0}, type.bytes);
  } else if (type.kind == Kind::floating) {  // implied leading bit; place of the sign; then offset, precision, parts
    const bool wide = type.bytes == 8;
    put(to, std::uint8_t{version | 1}, std::uint8_t{0x20}, std::uint8_t(bits - 1), std::uint8_t{0}, type.bytes,
        std::uint16_t{0}, bits);
    const std::uint8_t mantissa = wide ? 52 : 23, exponent = wide ? 11 : 8;
    put(to, mantissa, exponent, std::uint8_t{0}, mantissa, std::uint32_t(wide ? 1023 : 127));
  } else {
    const std::uint8_t sign = type.kind == Kind::whole ? 8 : 0;
    put(to, std::uint8_t{version | 0}, sign, std::uint16_t{0}, type.bytes, std::uint16_t{0}, bits);
  }
}

/// The messages of one object header.
class Header {
 public:
  void add(Message type, Bytes body, const std::string& path) {
    pad(body);
    if (body.size() > 65528) throw Error(path + ": an attribute is longer than 64 KiB, which HDF5 cannot store");
    put(bytes_, std::uint16_t{type}, std::uint16_t(body.size()), std::uint32_t{0});
    bytes_.insert(bytes_.end(), body.begin(), body.end());
    ++count_;
  }

  void add_attribute(const std::string& name, const Values& values, const std::string& path) {
    Bytes type, space, body;
    put_type(type, values.type);
    put_space(space, values.shape);
    put(body, std::uint8_t{1}, std::uint8_t{0}, std::uint16_t(name.size() + 1), std::uint16_t(type.size()),
        std::uint16_t(space.size()));
    put_text(body, name + '\0');
    pad(body);
    for (const Bytes* part : {&type, &space}) {
      body.insert(body.end(), part->begin(), part->end());
      pad(body);
    }
    body.insert(body.end(), values.bytes.begin(), values.bytes.end());
    add(attribute_message, std::move(body), path);
  }

  /// Appends the header to a file and returns where it begins.
  std::uint64_t append_to(Bytes& file) const {
    const std::uint64_t at = file.size();
    put(file, std::uint8_t{1}, std::uint8_t{0}, count_, std::uint32_t{1}, std::uint32_t(bytes_.size()),
        std::uint32_t{0});
    file.insert(file.end(), bytes_.begin(), bytes_.end());
    return at;
  }

 private:
  Bytes bytes_;
  std::uint16_t count_ = 0;
};

class Image {
 public:
  explicit Image(const Tree& tree) : tree_(tree) {
    for (const auto& [path, object] : tree.objects) {
      if (path == "/") continue;
      const auto slash = path.rfind('/');
      members_[slash == 0 ? "/" : path.substr(0, slash)].push_back({path.substr(slash + 1), path});
    }
  }

  Bytes made() {
    file_.resize(superblock_bytes);
    const Group root = group("/");
    Bytes superblock;
    put_text(superblock, "\x89HDF\r\n\x1a\n");
    put(superblock, std::uint32_t{0}, std::uint8_t{0}, std::uint8_t{8}, std::uint8_t{8}, std::uint8_t{0});
    put(superblock, leaf_k, node_k, std::uint32_t{0});
    put(superblock, std::uint64_t{0}, nowhere, std::uint64_t{file_.size()}, nowhere);
    put(superblock, std::uint64_t{0}, root.header, std::uint32_t{1}, std::uint32_t{0}, root.tree, root.heap);
    std::copy(superblock.begin(), superblock.end(), file_.begin());
    return std::move(file_);
  }

 private:
  struct Member {
    std::string name, path;
  };
  struct Group {
    std::uint64_t header, tree, heap;
  };
  /// A leaf or a node: where it begins, and where the last name below it stands in the heap.
  struct Branch {
    std::uint64_t at, last_name;
  };

  std::uint64_t dataset(const std::string& path, const Object& object) {
    const Values& values = *object.dataset;
    const std::uint64_t at = values.bytes.empty() ? nowhere : file_.size();
    file_.insert(file_.end(), values.bytes.begin(), values.bytes.end());
    pad(file_);
    Bytes space, type, fill, layout;
    put_space(space, values.shape);
    put_type(type, values.type);
    put(fill, std::uint8_t{2}, std::uint8_t{2}, std::uint8_t{2}, std::uint8_t{1}, std::uint32_t{0});
    put(layout, std::uint8_t{3}, std::uint8_t{1}, at, std::uint64_t{values.bytes.size()});
    Header header;
    header.add(dataspace_message, std::move(space), path);
    header.add(datatype_message, std::move(type), path);
    header.add(fill_value_message, std::move(fill), path);
    header.add(layout_message, std::move(layout), path);
    for (const auto& [name, attribute] : object.attributes) header.add_attribute(name, attribute, path);
    return header.append_to(file_);
  }

  Group group(const std::string& path) {
    Bytes names(8);  // the empty one
    std::vector<std::uint64_t> name_at, header_at;
    for (const Member& member : members_[path]) {
      const Object& object = tree_.objects.at(member.path);
      header_at.push_back(object.dataset ? dataset(member.path, object) : group(member.path).header);
      name_at.push_back(names.size());
      put_text(names, member.name + '\0');
      pad(names);
    }
    Group made{0, search_tree(name_at, header_at), file_.size()};
    put_text(file_, "HEAP");
    constexpr std::uint64_t nothing_free = 1;
    put(file_, std::uint32_t{0}, std::uint64_t{names.size()}, nothing_free, std::uint64_t{file_.size() + 28});
    file_.insert(file_.end(), names.begin(), names.end());
    Header header;
    Bytes table;
    put(table, made.tree, made.heap);
    header.add(symbol_table_message, std::move(table), path);
    for (const auto& [name, attribute] : tree_.objects.at(path).attributes) header.add_attribute(name, attribute, path);
    made.header = header.append_to(file_);
    return made;
  }

  /// Leaves of names in their order, and nodes above them up to one.
  std::uint64_t search_tree(const std::vector<std::uint64_t>& name_at, const std::vector<std::uint64_t>& header_at) {
    std::vector<Branch> branches;
    for (std::size_t begin = 0; begin < name_at.size(); begin += 2 * leaf_k) {
      const std::size_t end = std::min(name_at.size(), begin + 2 * leaf_k);
      branches.push_back({file_.size(), name_at[end - 1]});
      put_text(file_, "SNOD");
      put(file_, std::uint8_t{1}, std::uint8_t{0}, std::uint16_t(end - begin));
      for (std::size_t k = begin; k < end; ++k) {
        put(file_, name_at[k], header_at[k], std::uint64_t{0}, std::uint64_t{0}, std::uint64_t{0});
      }
      file_.resize(branches.back().at + 8 + 2 * leaf_k * 40);
    }
    for (std::uint8_t level = 0;; ++level) {
      branches = nodes_above(branches, level);
      if (branches.size() == 1) return branches.front().at;
    }
  }

  std::vector<Branch> nodes_above(const std::vector<Branch>& below, std::uint8_t level) {
    constexpr std::size_t most = 2 * node_k, bytes = 24 + 8 * (2 * most + 1);
    std::vector<Branch> nodes;
    std::uint64_t name_before = 0;
    const std::size_t count = std::max<std::size_t>(1, (below.size() + most - 1) / most);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t begin = k * most, end = std::min(below.size(), begin + most);
      const std::uint64_t at = file_.size();
      put_text(file_, "TREE");
      put(file_, std::uint8_t{0}, level, std::uint16_t(end - begin));
      put(file_, k == 0 ? nowhere : at - bytes, k + 1 == count ? nowhere : at + bytes, name_before);
      for (std::size_t child = begin; child < end; ++child) {
        put(file_, below[child].at, below[child].last_name);
        name_before = below[child].last_name;
      }
      file_.resize(at + bytes);
      nodes.push_back({at, name_before});
    }
    return nodes;
  }

  const Tree& tree_;
  std::map<std::string, std::vector<Member>> members_;
  Bytes file_;
};

}  // namespace

Bytes write(const Tree& tree) { return Image(tree).made(); }

std::string name(Type type) {
  if (type.kind == Kind::text) return "text";
  const char* const kind = type.kind == Kind::floating ? "float" : type.kind == Kind::whole ? "int" : "uint";
  return kind + std::to_string(8 * type.bytes);
}

}  // namespace rvelab::io::hdf5
