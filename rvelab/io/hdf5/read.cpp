// Groups, links and object headers of an HDF5 file. Declared in tree.hpp.
#include <set>

#include "rvelab/io/hdf5/bytes.hpp"
#include "rvelab/io/hdf5/tree.hpp"

namespace rvelab::io::hdf5 {
namespace {

constexpr const char* remedy_layout = "write the file with h5py's own settings (libver \"earliest\")";

struct HeaderMessage {
  std::uint16_t type;
  std::uint8_t flags;
  Part body;
};

class Reader {
 public:
  Reader(const std::string& path, Tree& tree)
      : path_(path), tree_(tree), file_(tree.storage.back(), path), values_(file_, tree, path) {}

  void read() {
    if (file_.size() < 96 || file_.byte(8) != 0 || file_.byte(13) != 8 || file_.byte(14) != 8) {
      if (file_.size() < 96) file_.damaged("it is truncated");
      throw InputError(path_ + ": is an HDF5 file of another layout (superblock of version " +
                       std::to_string(file_.byte(8)) + "); allowed: 0, with addresses of 8 bytes; " + remedy_layout);
    }
    if (file_.address(24) != 0 || file_.address(40) > file_.size()) file_.damaged("it is truncated");
    tree_.objects.clear();
    object("/", file_.address(64), 0);
  }

 private:
  [[noreturn]] void refuse(const std::string& object, const std::string& what, const std::string& remedy) const {
    throw InputError(path_ + ": " + object + " " + what + "; " + remedy);
  }

  std::vector<HeaderMessage> messages_of(const std::string& name, std::uint64_t address) {
    const Part head = file_.from(address);
    if (head.begins("OHDR")) refuse(name, "is stored in a newer layout of HDF5", remedy_layout);
    if (head.byte(0) != 1) head.damaged("the header of " + name + " is none");
    const auto count = head.get<std::uint16_t>(2);
    std::vector<Part> blocks{head.part(16, head.get<std::uint32_t>(8))};
    std::vector<HeaderMessage> messages;
    for (std::size_t block = 0, seen = 0; block < blocks.size(); ++block) {
      const Part bytes = blocks[block];  // a copy: the list grows
      for (std::uint64_t at = 0; at + 8 <= bytes.size() && seen < count; ++seen) {
        const auto size = bytes.get<std::uint16_t>(at + 2);
        const HeaderMessage message{bytes.get<std::uint16_t>(at), bytes.byte(at + 4), bytes.part(at + 8, size)};
        if (++messages_ > file_.size() / 8) file_.damaged("headers lie in one another");
        if (message.type == continuation_message)
          blocks.push_back(file_.part(message.body.address(0), message.body.address(8)));
        else
          messages.push_back(message);
        at += 8 + size;
      }
    }
    return messages;
  }

  static const HeaderMessage* find(const std::vector<HeaderMessage>& messages, Message type) {
    for (const HeaderMessage& message : messages) {
      if (message.type == type) return &message;
    }
    return nullptr;
  }

  void object(const std::string& name, std::uint64_t address, int depth) {
    if (depth > most_nested) {
      refuse(name, "lies in more than " + std::to_string(most_nested) + " groups in one another",
             "it is not rvelab's: leave it out");
    }
    if (!seen_.insert(address).second) {
      refuse(name, "is a second name of an object or of a group that it lies in",
             "allowed: one name for each; leave the second out");
    }
    const auto messages = messages_of(name, address);
    Object& made = tree_.objects[name];
    attributes(name, messages, made);
    if (find(messages, layout_message) != nullptr) return dataset(name, messages, made);
    if (const auto* table = find(messages, symbol_table_message)) {
      return group(name, table->body.address(0), table->body.address(8), depth);
    }
    if (find(messages, link_info_message) == nullptr) {
      refuse(name, "is neither a group nor a dataset", "it is not rvelab's: leave it out");
    }
    newer_group(name, messages, depth);
  }

  void dataset(const std::string& name, const std::vector<HeaderMessage>& messages, Object& made) {
    const std::string what = path_ + ": dataset " + name;
    if (find(messages, external_files_message) != nullptr) {
      throw InputError(what + " keeps its values in another file (external storage); allowed: values in the file " +
                       "itself; copy them into it");
    }
    if (const auto* filters = find(messages, filters_message); filters != nullptr && filters->body.byte(1) > 0) {
      throw InputError(what + " is compressed or filtered; allowed: values as they are; write it without filters");
    }
    const auto *type = find(messages, datatype_message), *shape = find(messages, dataspace_message);
    if (type == nullptr || shape == nullptr) file_.damaged(name + " has no type or no extents");
    expect_own(*type, what);
    made.dataset = values_.by_layout(stored_type(type->body, what), stored_shape(shape->body, what),
                                     find(messages, layout_message)->body, what);
  }

  /// A type may be shared by objects: then the message says where it is.
  static void expect_own(const HeaderMessage& message, const std::string& what) {
    if ((message.flags & 2) != 0) {
      throw InputError(what + " has a type that lies elsewhere; allowed: a type of its own; write it without named " +
                       "types");
    }
  }

  void attributes(const std::string& name, const std::vector<HeaderMessage>& messages, Object& made) {
    if (const auto* info = find(messages, attribute_info_message)) {
      const bool ordered = (info->body.byte(1) & 1) != 0;
      if (info->body.address(ordered ? 4 : 2) != nowhere) {
        refuse(name, "keeps its attributes in a newer layout of HDF5", remedy_layout);
      }
    }
    for (const HeaderMessage& message : messages) {
      if (message.type != attribute_message) continue;
      const Part& body = message.body;
      const auto version = body.byte(0);
      if (version < 1 || version > 3) body.damaged("an attribute of " + name + " is of no known version");
      const auto padded = [&](std::uint64_t size) { return version == 1 ? (size + 7) / 8 * 8 : size; };
      const std::uint64_t name_size = body.get<std::uint16_t>(2), type_size = body.get<std::uint16_t>(4),
                          shape_size = body.get<std::uint16_t>(6), at = version == 3 ? 9 : 8;
      const std::string attribute = body.part(at, name_size).text_to_nul(0);
      const std::string what = path_ + ": attribute " + attribute + " of " + name;
      if (version > 1) expect_own({0, std::uint8_t((body.byte(1) & 3) != 0 ? 2 : 0), body}, what);
      const std::uint64_t type_at = at + padded(name_size), shape_at = type_at + padded(type_size);
      made.attributes[attribute] = values_.in_place(stored_type(body.part(type_at, type_size), what),
                                                    stored_shape(body.part(shape_at, shape_size), what),
                                                    body.from(shape_at + padded(shape_size)), what);
    }
  }

  void member(const std::string& group, const std::string& name, std::uint64_t header, int depth) {
    const std::string path = (group == "/" ? "/" : group + "/") + name;
    if (name.empty() || name.find('/') != std::string::npos || tree_.objects.contains(path)) {
      file_.damaged("a name in " + group + " is none, or is there twice");
    }
    object(path, header, depth + 1);
  }

  void group(const std::string& name, std::uint64_t tree, std::uint64_t heap, int depth) {
    const Part head = file_.from(heap);
    if (!head.begins("HEAP")) head.damaged("the names of " + name + " are not where they should be");
    const Part names = file_.part(head.address(24), head.address(8));
    constexpr int highest_level = 8;
    node(name, tree, names, highest_level + 1, depth);
  }

  void node(const std::string& name, std::uint64_t address, const Part& names, int level_above, int depth) {
    const Part bytes = file_.from(address);
    if (!bytes.begins("TREE") || bytes.byte(4) != 0 || bytes.byte(5) >= level_above || !seen_.insert(address).second)
      bytes.damaged("the index of " + name + " is none");
    const auto entries = bytes.get<std::uint16_t>(6);
    for (std::uint64_t k = 0; k < entries; ++k) {
      const std::uint64_t child = bytes.address(32 + 16 * k);
      if (bytes.byte(5) > 0)
        node(name, child, names, bytes.byte(5), depth);
      else
        leaf(name, child, names, depth);
    }
  }

  void leaf(const std::string& group, std::uint64_t address, const Part& names, int depth) {
    const Part bytes = file_.from(address);
    if (!bytes.begins("SNOD") || !seen_.insert(address).second) bytes.damaged("the index of " + group + " is none");
    const auto entries = bytes.get<std::uint16_t>(6);
    constexpr std::uint32_t soft = 2;
    for (std::uint64_t k = 0; k < entries; ++k) {
      const Part entry = bytes.part(8 + 40 * k, 40);
      const std::string name = names.text_to_nul(entry.address(0));
      if (entry.get<std::uint32_t>(16) == soft) {
        refuse_link(group, name, names.text_to_nul(entry.get<std::uint32_t>(24)), false);
      }
      member(group, name, entry.address(8), depth);
    }
  }

  [[noreturn]] void refuse_link(const std::string& group, const std::string& name, const std::string& target,
                                bool external) const {
    refuse(
        (group == "/" ? "/" : group + "/") + name,
        std::string("is a link to ") + (external ? "another file" : "another name") + " (" + target.substr(0, 60) + ")",
        "allowed: objects of the file itself, each under one name; copy what is meant into its place");
  }

  /// A group that HDF5 has turned into its newer form, because a link of another file was put into it.
  void newer_group(const std::string& name, const std::vector<HeaderMessage>& messages, int depth) {
    const Part& info = find(messages, link_info_message)->body;
    if (info.address((info.byte(1) & 1) != 0 ? 10 : 2) != nowhere) {
      refuse(name, "keeps its members in a newer layout of HDF5 (external links, order of creation)",
             "allowed: objects of the file itself; copy them to a file with h5py's own settings");
    }
    for (const HeaderMessage& message : messages) {
      if (message.type == link_message) link(name, message.body, depth);
    }
  }

  void link(const std::string& group, const Part& body, int depth) {
    enum { hard = 0, soft = 1 };
    const auto flags = body.byte(1);
    std::uint64_t at = 2;
    const int kind = (flags & 8) != 0 ? body.byte(at++) : int(hard);
    at += ((flags & 4) != 0 ? 8 : 0) + ((flags & 16) != 0 ? 1 : 0);
    std::uint64_t length = 0;
    const int length_bytes = 1 << (flags & 3);
    for (int k = 0; k < length_bytes; ++k) length |= std::uint64_t{body.byte(at++)} << (8 * k);
    const std::string name = body.text(at, length);
    at += length;
    if (kind == hard) return member(group, name, body.address(at), depth);
    const auto size = body.get<std::uint16_t>(at);
    const bool external = kind != soft;
    // Of another file: a byte of flags, its name, NUL, the name in it, NUL.
    refuse_link(group, name, external ? body.part(at + 2, size).text_to_nul(1) : body.text(at + 2, size), external);
  }

  const std::string& path_;
  Tree& tree_;
  Part file_;
  ValueReader values_;
  std::set<std::uint64_t> seen_;  ///< addresses of headers, nodes and leaves
  std::uint64_t messages_ = 0;
};

}  // namespace

Tree read(const std::string& path, std::vector<std::byte> file) {
  Tree tree;
  tree.storage.push_back(std::move(file));
  Reader(path, tree).read();
  return tree;
}

}  // namespace rvelab::io::hdf5
