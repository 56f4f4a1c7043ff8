// The description of a specimen names every member, and everything that keeps or compares specimens goes by it.
#include "rvelab/specimen/specimen_fields.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "random_specimen.hpp"
#include "rvelab/io/hdf5/archive.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/solver/snapshot.hpp"
#include "tests/catch.hpp"
#include "tests/io/record_files.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;
using fields::Field;
using fields::Rows;

namespace {

/// A part as the solver has them, and descriptions of it that are right or wrong.
template <int>
struct Spring {
  double stiffness = 0;
  double length = 0;
  std::vector<double> forces;
};
using Whole = Spring<0>;
using Forgotten = Spring<1>;
using Twice = Spring<2>;
using SameName = Spring<3>;
using ListAsValue = Spring<4>;
struct Undescribed {
  double radius = 0;
};

}  // namespace

namespace rvelab::fields {

template <>
inline constexpr auto members_of<Whole> =
    std::tuple{Field{"stiffness", &Whole::stiffness, "N/m"}, Field{"length", &Whole::length, "m"},
               Field{"forces", &Whole::forces, "N", Rows::per_grain}};
template <>
inline constexpr auto members_of<Forgotten> = std::tuple{Field{"stiffness", &Forgotten::stiffness, "N/m"},
                                                         Field{"forces", &Forgotten::forces, "N", Rows::per_grain}};
template <>
inline constexpr auto members_of<Twice> =
    std::tuple{Field{"stiffness", &Twice::stiffness, "N/m"}, Field{"length", &Twice::stiffness, "m"},
               Field{"forces", &Twice::forces, "N", Rows::per_grain}};
template <>
inline constexpr auto members_of<SameName> =
    std::tuple{Field{"stiffness", &SameName::stiffness, "N/m"}, Field{"stiffness", &SameName::length, "m"},
               Field{"forces", &SameName::forces, "N", Rows::per_grain}};
template <>
inline constexpr auto members_of<ListAsValue> =
    std::tuple{Field{"stiffness", &ListAsValue::stiffness, "N/m"}, Field{"length", &ListAsValue::length, "m"},
               Field{"forces", &ListAsValue::forces, "N"}};

}  // namespace rvelab::fields

namespace {

/// A file's dataset as the description has it.
struct Dataset {
  std::string type, units;
  io::Shape64 shape;
  bool operator==(const Dataset&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Dataset& dataset) {
  out << dataset.type << " [" << dataset.units << "] (";
  for (const auto extent : dataset.shape) out << extent << ",";
  return out << ")";
}

/// The datasets that a specimen has by its description, by their paths.
struct Datasets {
  std::map<std::string, Dataset> found;

  template <class Value, class Described>
  void field(const fields::Path& path, const Value& value, const Described& field) {
    io::Shape64 shape;
    if constexpr (fields::Listed<Value>::is_list) shape.push_back(value.size());
    add<typename fields::Listed<Value>::Entry>(path.text(), field.units, shape);
  }
  template <class Item, class... Columns>
  void table(const fields::Path& path, const std::vector<Item>& items, const Columns&... columns) {
    (add_column(fields::Path(&path, columns.name).text(), items.size(), columns), ...);
  }

 private:
  template <class Item, class Value>
  void add_column(const std::string& path, std::size_t rows, const Field<Item, Value>& column) {
    add<Value>(path, column.units, {rows});
  }
  template <class Value>
  void add(const std::string& path, const std::string& units, io::Shape64 shape) {
    std::string type = "text";
    if constexpr (!fields::Textual<Value>) {
      using Scalar = typename fields::Layout<Value>::Scalar;
      const std::string bits = std::to_string(8 * sizeof(Scalar));
      type = (std::is_floating_point_v<Scalar> ? "float" : std::is_signed_v<Scalar> ? "int" : "uint") + bits;
      for (const auto extent : fields::Layout<Value>::extents) shape.push_back(extent);
    }
    CHECK(found.emplace("/" + path, Dataset{type, units, shape}).second);
  }
};

/// Changes one field, and in it the last bit of the last entry.
class Change {
 public:
  explicit Change(std::size_t number) : number_(number) {}
  const std::string& path() const { return path_; }  ///< "": there are fewer fields

  template <class Value, class Described>
  void field(const fields::Path& path, Value& value, const Described&) {
    if (is_it(path.text())) change(value);
  }
  template <class Item, class... Columns>
  void table(const fields::Path& path, std::vector<Item>& items, const Columns&... columns) {
    (column(fields::Path(&path, columns.name).text(), items, columns), ...);
  }

 private:
  bool is_it(const std::string& path) {
    const bool is = number_-- == 0;
    if (is) path_ = path;
    return is;
  }
  template <class Item, class Value>
  void column(const std::string& path, std::vector<Item>& items, const Field<Item, Value>& column) {
    if (is_it(path)) change(items.back().*column.member);
  }
  template <class Value>
  static void change(std::vector<Value>& values) {
    change(values.back());
  }
  static void change(std::string& text) { text += "x"; }
  static void change(bool& value) { value = !value; }
  static void change(Vector3& value) { change(value[2]); }
  static void change(Matrix3& value) { change(value(1, 2)); }
  static void change(Image& value) { change(value[2]); }
  static void change(Turn& value) { change(value.w); }
  template <class Value>
  static void change(Value& value) {
    if constexpr (std::is_enum_v<Value>) {
      value = value == Value(0) ? Value(1) : Value(0);
    } else {
      using Bits = std::conditional_t<sizeof(Value) == 4, std::uint32_t, std::uint64_t>;
      value = std::bit_cast<Value>(std::bit_cast<Bits>(value) ^ 1);
    }
  }

  std::size_t number_;
  std::string path_;
};

/// Sets every number that may be one to the same double.
struct SetDoubles {
  double to;

  template <class Value, class Described>
  void field(const fields::Path&, Value& value, const Described&) {
    set(value);
  }
  template <class Item, class... Columns>
  void table(const fields::Path&, std::vector<Item>& items, const Columns&... columns) {
    for (Item& item : items) (set(item.*columns.member), ...);
  }

 private:
  void set(double& value) { std::memcpy(&value, &to, sizeof to); }
  void set(Vector3& value) {
    for (int k = 0; k < 3; ++k) set(value[k]);
  }
  void set(Matrix3& value) {
    for (int k = 0; k < 9; ++k) set(value(k / 3, k % 3));
  }
  void set(Turn& value) {
    set(value.w);
    set(value.v);
  }
  template <class Value>
  void set(std::vector<Value>& values) {
    for (Value& value : values) set(value);
  }
  template <class Value>
  void set(Value&) {}
};

/// The specimen of a file as its bits are stored.
Specimen stored(const std::string& path) { return io::stored_specimen(io::Hdf5File::open(path), ""); }

}  // namespace

TEST_CASE("a struct is described if each of its members is, once and under a name of its own") {
  CHECK(fields::member_count<Whole>() == 3);
  CHECK(fields::describes_every_member<Whole>());
  CHECK(!fields::describes_every_member<Forgotten>());
  CHECK(!fields::describes_every_member<Twice>());
  CHECK(!fields::describes_every_member<SameName>());
  CHECK(!fields::describes_every_member<ListAsValue>());
  CHECK(!fields::describes_every_member<Undescribed>());  // not described at all
  CHECK(fields::member_count<Cell>() == 4);
  CHECK(fields::member_count<Contact>() == 6);    // its image is an array
  CHECK(fields::member_count<Specimen>() == 12);  // and one for the interactions, its base
}

TEST_CASE("the described fields are the datasets of a file, no more and no fewer, with their types, units and shapes") {
  const Folder folder;
  const Specimen specimen = random_bits(21);
  io::write_specimen(specimen, folder / "s.h5");
  Datasets described;
  fields::visit(described, specimen);
  std::map<std::string, Dataset> written;
  for (const auto& entry : io::Hdf5File::open(folder / "s.h5").entries())
    written[entry.name] = {entry.type, entry.units, entry.shape};
  CHECK(written.size() > 70);
  for (const auto& [path, dataset] : described.found) {
    CAPTURE(path);
    REQUIRE(written.contains(path));
    CHECK(written[path] == dataset);
  }
  for (const auto& [path, dataset] : written) {
    CAPTURE(path);
    CHECK(described.found.contains(path));
  }
  CHECK(described.found.at("/state/energy_balance/friction_J") == Dataset{"float64", "J", {}});
  CHECK(described.found.at("/cell/lattice_m") == Dataset{"float64", "m", {3, 3}});
  CHECK(described.found.at("/contacts/image") == Dataset{"int32", "1", {31, 3}});
}

TEST_CASE("one bit of any one field is seen by comparison, digest, snapshot and file, and comes back from them") {
  const Folder folder;
  const Specimen before = random_bits(22);
  const auto bytes_before = to_bytes(before);
  io::write_specimen(before, folder / "a.h5");
  std::size_t number = 0;
  for (;; ++number) {
    Specimen changed = before;
    Change change(number);
    fields::visit(change, changed);
    if (change.path().empty()) break;
    CAPTURE(change.path());
    CHECK(differing_fields(before, changed) == std::vector<std::string>{change.path()});
    CHECK(io::digest(changed) != io::digest(before));

    const auto bytes = to_bytes(changed);
    CHECK(bool(bytes != bytes_before));
    CHECK(differing_fields(from_bytes(bytes), changed).empty());

    io::write_specimen(changed, folder / "b.h5");
    CHECK_THAT(test::first_difference(folder / "a.h5", folder / "b.h5").value_or(""), Contains("/" + change.path()));
    CHECK(differing_fields(stored(folder / "b.h5"), changed).empty());
  }
  Datasets described;
  fields::visit(described, before);
  CHECK(number == described.found.size());
}

TEST_CASE("every field keeps every double: NaNs with what they carry, -0, infinities, the smallest") {
  const Folder folder;
  using Limits = std::numeric_limits<double>;
  const Specimen random = random_bits(23);
  for (const double value : {std::bit_cast<double>(0x7ff8000000c0ffeeULL), std::bit_cast<double>(0xfff4000000000001ULL),
                             -0.0, Limits::infinity(), -Limits::infinity(), Limits::denorm_min(), Limits::max()}) {
    CAPTURE(value);
    Specimen written = random, zero = random;
    SetDoubles set{value}, clear{0};
    fields::visit(set, written);
    fields::visit(clear, zero);
    CHECK(differing_fields(written, zero).size() > 40);
    CHECK(differing_fields(from_bytes(to_bytes(written)), written).empty());
    io::write_specimen(written, folder / "a.h5");
    io::write_specimen(written, folder / "b.h5");
    io::write_specimen(zero, folder / "c.h5");
    CHECK(differing_fields(stored(folder / "a.h5"), written).empty());
    CHECK(!test::first_difference(folder / "a.h5", folder / "b.h5"));
    CHECK_THAT(test::first_difference(folder / "a.h5", folder / "c.h5").value_or(""), Contains("differs"));
  }
}
