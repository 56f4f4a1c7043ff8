// Snapshots: a specimen as bytes, for builds with the same fields, and back.
#include "rvelab/solver/snapshot.hpp"

#include <string>
#include <type_traits>

#include "rvelab/error.hpp"
#include "rvelab/specimen/specimen_fields.hpp"

namespace rvelab {

namespace {

using fields::Field;
using fields::Layout;
using fields::Listed;
using fields::Path;
using fields::Textual;

constexpr char magic[8] = {'r', 'v', 'e', 's', 'n', 'a', 'p', '5'};

/// Bytes of one value; of a text, those of its length at least.
template <class Value>
constexpr std::size_t least_bytes() {
  if constexpr (Textual<Value>) {
    return sizeof(std::uint64_t);
  } else {
    return sizeof(typename Layout<Value>::Scalar) * Layout<Value>::size;
  }
}

/// The fields of a build in words.
struct LayoutWords {
  std::string words = std::endian::native == std::endian::little ? "little-endian\n" : "big-endian\n";

  template <class Value, class Described>
  void field(const Path& path, const Value&, const Described& field) {
    add<Value>(path.text(), field.units);
  }
  template <class Item, class... Columns>
  void table(const Path& path, const std::vector<Item>&, const Columns&... columns) {
    words += path.text() + "[]\n";
    (add_column(columns), ...);
  }

 private:
  template <class Item, class Value>
  void add_column(const Field<Item, Value>& column) {
    add<Value>(column.name, column.units);
  }
  template <class Value>
  void add(const std::string& name, const char* units) {
    using Entry = typename Listed<Value>::Entry;
    words += name + " " + units + " ";
    if constexpr (Textual<Entry>) {
      words += "text";
    } else {
      using Scalar = typename Layout<Entry>::Scalar;
      words += std::is_floating_point_v<Scalar> ? "float" : std::is_signed_v<Scalar> ? "int" : "uint";
      words += std::to_string(8 * sizeof(Scalar)) + " x " + std::to_string(Layout<Entry>::size);
    }
    words += Listed<Value>::is_list ? "[]\n" : "\n";
  }
};

std::uint64_t layout_of_this_build() {
  static const std::uint64_t sum = [] {
    LayoutWords layout;
    const Specimen any;
    fields::visit(layout, any);
    return snapshot_checksum(std::as_bytes(std::span(layout.words)));
  }();
  return sum;
}

/// Puts the fields one behind the other; without a place for them (nullptr) it counts their bytes.
struct Writer {
  std::byte* to = nullptr;
  std::size_t size = 0;

  template <class Value, class Described>
  void field(const Path&, const Value& value, const Described&) {
    put(value);
  }
  template <class Item, class... Columns>
  void table(const Path&, const std::vector<Item>& items, const Columns&... columns) {
    put(std::uint64_t(items.size()));
    (column(items, columns), ...);
  }

 private:
  void add(const void* from, std::size_t bytes) {
    if (to != nullptr && bytes > 0) std::memcpy(to + size, from, bytes);
    size += bytes;
  }
  template <class Value>
  void put(const Value& value) {
    if constexpr (Textual<Value>) {
      const std::string text = fields::text_of(value);
      put(std::uint64_t(text.size()));
      add(text.data(), text.size());
    } else {
      typename Layout<Value>::Scalar scalars[Layout<Value>::size];
      Layout<Value>::put(value, scalars);
      add(scalars, sizeof scalars);
    }
  }
  template <class Value>
  void put(const std::vector<Value>& values) {
    static_assert(Layout<Value>::in_order, "say here how a list of these is put");
    put(std::uint64_t(values.size()));
    add(values.data(), values.size() * least_bytes<Value>());
  }
  template <class Item, class Value>
  void column(const std::vector<Item>& items, const Field<Item, Value>& column) {
    for (const Item& item : items) put(item.*column.member);
  }
};

/// Takes the fields off the front. A checksum is no proof of what is below it: lengths are held against the bytes that
/// are left before there is room made for them, and choices and booleans against those that there are.
struct Reader {
  std::span<const std::byte> left;

  template <class Value, class Described>
  void field(const Path& path, Value& value, const Described&) {
    get(path, value);
  }
  template <class Item, class... Columns>
  void table(const Path& path, std::vector<Item>& items, const Columns&... columns) {
    items.resize(count(path, (least_bytes_of(columns) + ...)));
    (column(path, items, columns), ...);
  }

 private:
  [[noreturn]] static void refuse(const Path& path, const std::string& what) {
    throw InputError("snapshot: " + path.text() + " " + what + "; it was damaged: save it again");
  }
  const std::byte* next(const Path& path, std::size_t bytes) {
    if (bytes > left.size()) refuse(path, "is beyond its end");
    const std::byte* const at = left.data();
    left = left.subspan(bytes);
    return at;
  }
  /// Length of what follows, each entry at least so many bytes.
  std::size_t count(const Path& path, std::size_t bytes_each) {
    std::uint64_t entries = 0;
    std::memcpy(&entries, next(path, sizeof entries), sizeof entries);
    if (entries > left.size() / bytes_each) {
      refuse(path,
             "says that it has " + std::to_string(entries) + " entries, more than the bytes that are left can hold");
    }
    return std::size_t(entries);
  }
  template <class Item, class Value>
  static constexpr std::size_t least_bytes_of(const Field<Item, Value>&) {
    return least_bytes<Value>();
  }
  template <class Value>
  void get(const Path& path, Value& value) {
    if constexpr (Textual<Value>) {
      const std::size_t letters = count(path, 1);
      const auto* const text = reinterpret_cast<const char*>(next(path, letters));
      try {
        fields::from_text({text, letters}, value);
      } catch (const InputError& error) {
        refuse(path, std::string("holds no word that is known: ") + error.what());
      }
    } else {
      typename Layout<Value>::Scalar scalars[Layout<Value>::size];
      std::memcpy(scalars, next(path, sizeof scalars), sizeof scalars);
      if constexpr (std::is_same_v<Value, bool>)
        if (scalars[0] > 1) refuse(path, "is " + std::to_string(scalars[0]) + "; allowed: 0, 1");
      Layout<Value>::get(scalars, value);
    }
  }
  template <class Value>
  void get(const Path& path, std::vector<Value>& values) {
    values.resize(count(path, least_bytes<Value>()));
    const std::byte* const at = next(path, values.size() * least_bytes<Value>());
    static_assert(Layout<Value>::in_order, "say here how a list of these is taken");
    if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), at, values.size() * least_bytes<Value>());
  }
  template <class Item, class Value>
  void column(const Path& table, std::vector<Item>& items, const Field<Item, Value>& column) {
    const Path path(&table, column.name);
    for (Item& item : items) get(path, item.*column.member);
  }
};

std::string in_hexadecimal(std::uint64_t value) {
  TextStream text;
  text << std::hex << value;
  return text.str();
}

}  // namespace

std::vector<std::byte> to_bytes(const Specimen& specimen) {
  Writer counter;
  fields::visit(counter, specimen);
  std::vector<std::byte> bytes(sizeof(SnapshotHead) + counter.size);
  Writer writer{bytes.data() + sizeof(SnapshotHead)};
  fields::visit(writer, specimen);
  SnapshotHead head{{}, layout_of_this_build(), counter.size, 0};
  std::memcpy(head.magic, magic, sizeof magic);
  head.checksum = snapshot_checksum(std::span(bytes).subspan(sizeof head));
  std::memcpy(bytes.data(), &head, sizeof head);
  return bytes;
}

Specimen from_bytes(std::span<const std::byte> bytes) {
  const std::string elsewhere = "; write a specimen file to carry a state from one build to another";
  SnapshotHead head{};
  if (bytes.size() >= sizeof head) std::memcpy(&head, bytes.data(), sizeof head);
  if (std::memcmp(head.magic, magic, sizeof magic) != 0)
    throw InputError("snapshot: its " + std::to_string(bytes.size()) +
                     " bytes do not begin as those of a snapshot of " + "this version (\"" +
                     std::string(magic, sizeof magic) + "\")" + elsewhere);
  if (head.layout != layout_of_this_build())
    throw InputError("snapshot: its fields have the layout " + in_hexadecimal(head.layout) +
                     "; allowed: that of this build, " + in_hexadecimal(layout_of_this_build()) + elsewhere);
  Reader in{bytes.subspan(sizeof head)};
  if (head.length != in.left.size())
    throw InputError("snapshot: it has " + std::to_string(in.left.size()) + " bytes behind its head, which says " +
                     std::to_string(head.length) + "; it was cut short or damaged: save it again");
  if (head.checksum != snapshot_checksum(in.left))
    throw InputError("snapshot: its checksum does not fit its bytes; it was damaged: save it again");
  Specimen specimen;
  fields::visit(in, specimen);
  if (!in.left.empty())
    throw InputError("snapshot: " + std::to_string(in.left.size()) +
                     " bytes are left behind its last field; it was damaged: save it again");
  return specimen;
}

}  // namespace rvelab
