// One description of a value, two directions: Writer and Reader carry the same fields to and from an HDF5 file, so
// that what is written and what is read cannot differ. A description is a template over the archive and calls
//
//     archive.field("grains/radius_m", grains.radius, "m");                       // one dataset, a value or a vector
//     archive.table("contacts", contacts, Column{"i", &Contact::i, "1"}, ...);    // one dataset a column
//
// Doubles keep every bit. Truth values are uint8, enumerations their names, vectors and images rows of three, 3x3
// matrices row-major.
#pragma once

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5_file.hpp"
#include "rvelab/keys/words.hpp"
#include "rvelab/records/column.hpp"

namespace rvelab::io {

using keys::from_text;
using keys::text_of;
using keys::Textual;
using records::Column;

/// How one numeric value lies in a file: the scalar's type, and the extents of one value.
template <class Value>
struct Layout {
  static_assert(std::is_arithmetic_v<Value>);
  using Integer = std::conditional_t<sizeof(Value) == 4, std::int32_t,
                                     std::conditional_t<std::is_signed_v<Value>, std::int64_t, std::uint64_t>>;
  using Scalar = std::conditional_t<std::is_same_v<Value, bool>, std::uint8_t,
                                    std::conditional_t<std::is_floating_point_v<Value>, double, Integer>>;
  static_assert(sizeof(Scalar) == sizeof(Value));
  static constexpr std::size_t size = 1;
  static Shape64 shape() { return {}; }
  static void put(const Value& value, Scalar* row) { row[0] = static_cast<Scalar>(value); }
  static void get(const Scalar* row, Value& value) { value = static_cast<Value>(row[0]); }
};

template <>
struct Layout<Vector3> {
  using Scalar = double;
  static constexpr std::size_t size = 3;
  static Shape64 shape() { return {3}; }
  static void put(const Vector3& value, double* row) { std::copy_n(value.data(), 3, row); }
  static void get(const double* row, Vector3& value) { std::copy_n(row, 3, value.data()); }
};

template <>
struct Layout<Image> {
  using Scalar = std::int32_t;
  static constexpr std::size_t size = 3;
  static Shape64 shape() { return {3}; }
  static void put(const Image& value, std::int32_t* row) { std::copy_n(value.data(), 3, row); }
  static void get(const std::int32_t* row, Image& value) { std::copy_n(row, 3, value.data()); }
};

template <>
struct Layout<Matrix3> {
  using Scalar = double;
  static constexpr std::size_t size = 9;
  static Shape64 shape() { return {3, 3}; }
  static void put(const Matrix3& value, double* row) {
    for (int k = 0; k < 9; ++k) row[k] = value(k / 3, k % 3);
  }
  static void get(const double* row, Matrix3& value) {
    for (int k = 0; k < 9; ++k) value(k / 3, k % 3) = row[k];
  }
};

/// Writes values under a group of a file. `chunk_rows` > 0: columns of tables are stored in chunks of so many rows.
class Writer {
 public:
  Writer(Hdf5File& file, std::string group, std::uint64_t chunk_rows = 0)
      : file_(file), group_(std::move(group)), chunk_rows_(chunk_rows) {}

  template <class Value>
  void field(const std::string& name, const Value& value, const std::string& units) {
    rows<Value>(
        name, 1, [&](std::size_t) -> const Value& { return value; }, {}, units);
  }
  template <class Value>
  void field(const std::string& name, const std::vector<Value>& values, const std::string& units) {
    rows<Value>(
        name, values.size(), [&](std::size_t k) -> const Value& { return values[k]; }, {values.size()}, units);
  }
  template <class Value>
  void later_field(const std::string& name, const Value& value, const std::string& units, const Value& = {}) {
    field(name, value, units);
  }
  template <class Item, class... Columns>
  void table(const std::string& group, const std::vector<Item>& items, const Columns&... columns) {
    (column(group, items, columns), ...);
  }
  template <class Item, class Member>
  void later_column(const std::string& group, const std::vector<Item>& items, const Column<Item, Member>& column) {
    this->column(group, items, column);
  }
  /// Which columns count, bit by bit in a member of each item: the columns that are there say it.
  template <class Item, class Member>
  void choice(const std::string&, const std::vector<Item>&, const Column<Item, Member>&) {}
  /// A column that is written where it was chosen; the first item speaks for all.
  template <class Item, class Member, class Mask>
  void chosen(const std::string& group, const std::vector<Item>& items, const Column<Item, Member>& column,
              Mask Item::*mask, Mask bit) {
    if (((items.empty() ? Item{} : items.front()).*mask & bit) != 0) this->column(group, items, column);
  }

 private:
  template <class Item, class Member>
  void column(const std::string& group, const std::vector<Item>& items, const Column<Item, Member>& column) {
    rows<Member>(
        group + "/" + column.name, items.size(),
        [&](std::size_t k) -> const Member& { return items[k].*column.member; }, {items.size()}, column.units,
        chunk_rows_);
  }

  template <class Value, class At>
  void rows(const std::string& name, std::size_t count, At at, Shape64 shape, const std::string& units,
            std::uint64_t chunk_rows = 0) {
    if constexpr (Textual<Value>) {
      std::vector<std::string> texts;
      for (std::size_t k = 0; k < count; ++k) texts.push_back(text_of(at(k)));
      file_.write_text(group_ + "/" + name, texts, shape);
    } else {
      using Row = Layout<Value>;
      std::vector<typename Row::Scalar> scalars(count * Row::size);
      for (std::size_t k = 0; k < count; ++k) Row::put(at(k), scalars.data() + k * Row::size);
      for (const auto extent : Row::shape()) shape.push_back(extent);
      file_.write<typename Row::Scalar>(group_ + "/" + name, scalars, shape, units, chunk_rows);
    }
  }

  Hdf5File& file_;
  std::string group_;
  std::uint64_t chunk_rows_;
};

/// Reads values from under a group of a file. InputError naming file and dataset if one is missing or does not fit.
class Reader {
 public:
  Reader(const Hdf5File& file, std::string group) : file_(file), group_(std::move(group)) {}

  template <class Value>
  void field(const std::string& name, Value& value, const std::string&) {
    expect_shape<Value>(name, {});
    rows<Value>(name, 1, [&](std::size_t) -> Value& { return value; });
  }
  template <class Value>
  void field(const std::string& name, std::vector<Value>& values, const std::string&) {
    values.resize(leading_extent(name));
    expect_shape<Value>(name, {values.size()});
    rows<Value>(name, values.size(), [&](std::size_t k) -> Value& { return values[k]; });
  }
  /// A field that files of earlier versions do not have: left as it is there.
  template <class Value>
  void later_field(const std::string& name, Value& value, const std::string& units, const Value& = {}) {
    if (file_.has(group_ + "/" + name)) field(name, value, units);
  }
  template <class Item, class First, class... Columns>
  void table(const std::string& group, std::vector<Item>& items, const First& first, const Columns&... columns) {
    items.assign(leading_extent(group + "/" + first.name), Item{});
    column(group, items, first);
    (column(group, items, columns), ...);
  }
  /// A column that files of earlier versions do not have: left as it is there.
  template <class Item, class Member>
  void later_column(const std::string& group, std::vector<Item>& items, const Column<Item, Member>& column) {
    if (file_.has(group_ + "/" + group + "/" + column.name)) this->column(group, items, column);
  }
  template <class Item, class Member>
  void choice(const std::string&, std::vector<Item>&, const Column<Item, Member>&) {}
  template <class Item, class Member, class Mask>
  void chosen(const std::string& group, std::vector<Item>& items, const Column<Item, Member>& column, Mask Item::*mask,
              Mask bit) {
    const bool there = file_.has(group_ + "/" + group + "/" + column.name);
    if (there) this->column(group, items, column);
    for (Item& item : items) item.*mask = there ? item.*mask | bit : item.*mask & ~bit;
  }

 private:
  template <class Item, class Member>
  void column(const std::string& group, std::vector<Item>& items, const Column<Item, Member>& column) {
    const std::string name = group + "/" + column.name;
    expect_shape<Member>(name, {items.size()});
    rows<Member>(name, items.size(), [&](std::size_t k) -> Member& { return items[k].*column.member; });
  }

  std::size_t leading_extent(const std::string& name) const {
    const Shape64 shape = file_.shape(group_ + "/" + name);
    return shape.empty() ? 0 : shape.front();
  }

  template <class Value>
  void expect_shape(const std::string& name, Shape64 expected) const {
    if constexpr (!Textual<Value>) {
      for (const auto extent : Layout<Value>::shape()) expected.push_back(extent);
    }
    const Shape64 found = file_.shape(group_ + "/" + name);
    if (found != expected) {
      throw InputError(file_.path() + ": dataset " + group_ + "/" + name + " has the shape " + in_words(found) +
                       "; allowed: " + in_words(expected) + "; the file is damaged: write it again");
    }
  }

  static std::string in_words(const Shape64& shape) {
    std::string text;
    for (const auto extent : shape) text += (text.empty() ? "" : ", ") + std::to_string(extent);
    return "(" + text + ")";
  }

  template <class Value, class At>
  void rows(const std::string& name, std::size_t count, At at) {
    const std::string path = group_ + "/" + name;
    if constexpr (Textual<Value>) {
      const auto texts = file_.read_text(path);
      try {
        for (std::size_t k = 0; k < count; ++k) from_text(texts[k], at(k));
      } catch (const InputError& error) {
        throw InputError(file_.path() + ": dataset " + path + ": " + error.what());
      }
    } else {
      using Row = Layout<Value>;
      const auto scalars = file_.read<typename Row::Scalar>(path);
      for (std::size_t k = 0; k < count; ++k) Row::get(scalars.data() + k * Row::size, at(k));
    }
  }

  const Hdf5File& file_;
  std::string group_;
};

}  // namespace rvelab::io
