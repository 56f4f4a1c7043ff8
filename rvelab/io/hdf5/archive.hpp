// One description of a value, two directions: Writer and Reader carry the same fields to and from an HDF5 file, so
// that what is written and what is read cannot differ. A description is a template over the archive and calls
//
//     archive.field("grains/radius_m", grains.radius, "m");                      // one dataset, a value or a vector
//     archive.table("contacts", contacts, Field{"i", &Contact::i, "1"}, ...);    // one dataset a column
//
// A specimen is shown to an archive by its own description (Described). How one value lies in a dataset: Layout.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/io/crc32c.hpp"
#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/specimen/described.hpp"

namespace rvelab::io {

using fields::Field;
using fields::from_text;
using fields::Layout;
using fields::text_of;
using fields::Textual;

/// Whether a file omits this column of these rows: all are zero, and none is -0, whose sign would be lost.
template <class Item, class Member>
bool omits_column(const Field<Item, Member>& column, const std::vector<Item>& rows) {
  if constexpr (std::is_same_v<Member, double>) {
    const auto is_zero = [&](const Item& row) { return row.*column.member == 0 && !std::signbit(row.*column.member); };
    return column.left_out_at_zero && std::all_of(rows.begin(), rows.end(), is_zero);
  }
  return false;
}

/// Shows the fields of a specimen (specimen_fields.hpp) to an archive, each under its path.
template <class Archive>
struct Described {
  Archive& archive;

  template <class Value, class Owner, class Member>
  void field(const fields::Path& path, Value& value, const Field<Owner, Member>& field) {
    if constexpr (fields::Listed<std::remove_const_t<Value>>::is_list)
      if (field.rows == fields::Rows::per_grain_or_left_out && archive.leaves_out(path.text(), value)) return;
    archive.field(path.text(), value, field.units);
  }
  template <class Items, class... Columns>
  void table(const fields::Path& path, Items& items, const Columns&... columns) {
    archive.table(path.text(), items, columns...);
  }
};

/// Writes values under a group of a file.
class Writer {
 public:
  Writer(Hdf5File& file, std::string group) : file_(file), group_(std::move(group)) {}

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
  bool leaves_out(const std::string&, const std::vector<Value>& values) const {
    return values.empty();
  }
  template <class Item, class... Columns>
  void table(const std::string& group, const std::vector<Item>& items, const Columns&... columns) {
    if (fields::left_out_where_empty<Item> && items.empty()) return;
    (column(group, items, columns), ...);
  }
  /// Which columns count, bit by bit in a member of each item: the columns that are there say it.
  template <class Item, class Member>
  void choice(const std::string&, const std::vector<Item>&, const Field<Item, Member>&) {}
  /// A column that is written where it was chosen; the first item speaks for all.
  template <class Item, class Member, class Mask>
  void chosen(const std::string& group, const std::vector<Item>& items, const Field<Item, Member>& column,
              Mask Item::*mask, Mask bit) {
    if (((items.empty() ? Item{} : items.front()).*mask & bit) != 0) this->column(group, items, column);
  }

 private:
  template <class Item, class Member>
  void column(const std::string& group, const std::vector<Item>& items, const Field<Item, Member>& column) {
    if (omits_column(column, items)) return;
    rows<Member>(
        group + "/" + column.name, items.size(),
        [&](std::size_t k) -> const Member& { return items[k].*column.member; }, {items.size()}, column.units);
  }

  template <class Value, class At>
  void rows(const std::string& name, std::size_t count, At at, Shape64 shape, const std::string& units) {
    if constexpr (Textual<Value>) {
      std::vector<std::string> texts;
      for (std::size_t k = 0; k < count; ++k) texts.push_back(text_of(at(k)));
      file_.write_text(group_ + "/" + name, texts, shape);
    } else {
      using Row = Layout<Value>;
      std::vector<typename Row::Scalar> scalars(count * Row::size);
      for (std::size_t k = 0; k < count; ++k) Row::put(at(k), scalars.data() + k * Row::size);
      shape.insert(shape.end(), Row::extents.begin(), Row::extents.end());
      file_.write<typename Row::Scalar>(group_ + "/" + name, scalars, shape, units);
    }
  }

  Hdf5File& file_;
  std::string group_;
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
    const std::size_t size = leading_extent(name);
    expect_shape<Value>(name, {size});
    values.resize(size);
    rows<Value>(name, values.size(), [&](std::size_t k) -> Value& { return values[k]; });
  }
  template <class Value>
  bool leaves_out(const std::string& name, std::vector<Value>& values) const {
    values.clear();
    return !file_.has(group_ + "/" + name);
  }
  template <class Item, class First, class... Columns>
  void table(const std::string& group, std::vector<Item>& items, const First& first, const Columns&... columns) {
    items.clear();
    if (fields::left_out_where_empty<Item> && !file_.has(group_ + "/" + group)) return;
    items.assign(rows_of(group, first), Item{});
    column(group, items, first);
    (column(group, items, columns), ...);
  }
  template <class Item, class Member>
  void choice(const std::string&, std::vector<Item>&, const Field<Item, Member>&) {}
  template <class Item, class Member, class Mask>
  void chosen(const std::string& group, std::vector<Item>& items, const Field<Item, Member>& column, Mask Item::*mask,
              Mask bit) {
    const bool there = file_.has(group_ + "/" + group + "/" + column.name);
    if (there) this->column(group, items, column);
    for (Item& item : items) item.*mask = there ? item.*mask | bit : item.*mask & ~bit;
  }

 private:
  template <class Item, class Member>
  void column(const std::string& group, std::vector<Item>& items, const Field<Item, Member>& column) {
    const std::string name = group + "/" + column.name;
    if (column.left_out_at_zero && !file_.has(group_ + "/" + name)) return;
    expect_shape<Member>(name, {items.size()});
    rows<Member>(name, items.size(), [&](std::size_t k) -> Member& { return items[k].*column.member; });
  }

  template <class Item, class Member>
  std::size_t rows_of(const std::string& group, const Field<Item, Member>& first) const {
    const std::size_t rows = leading_extent(group + "/" + first.name);
    expect_shape<Member>(group + "/" + first.name, {rows});  // before there is memory for so many
    return rows;
  }

  std::size_t leading_extent(const std::string& name) const {
    const Shape64 shape = file_.shape(group_ + "/" + name);
    return shape.empty() ? 0 : shape.front();
  }

  template <class Value>
  void expect_shape(const std::string& name, Shape64 expected) const {
    if constexpr (!Textual<Value>) {
      expected.insert(expected.end(), Layout<Value>::extents.begin(), Layout<Value>::extents.end());
    }
    const Shape64 found = file_.shape(group_ + "/" + name);
    if (found != expected) {
      throw InputError(file_.path() + ": dataset " + group_ + "/" + name + " has the shape " + in_words(found) +
                       "; allowed: " + in_words(expected) + "; the file is damaged: write it again");
    }
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

/// CRC-32C over the bits of all values, in the order of their description: equal for equal values on every machine.
class Digest {
 public:
  std::uint32_t sum() const { return sum_; }

  template <class Value>
  void field(const std::string&, const Value& value, const std::string&) {
    add(value);
  }
  template <class Value>
  void field(const std::string&, const std::vector<Value>& values, const std::string&) {
    add(std::uint64_t(values.size()));
    for (const Value& value : values) add(value);
  }
  template <class Value>
  bool leaves_out(const std::string&, const std::vector<Value>& values) const {
    return values.empty();
  }
  template <class Item, class... Columns>
  void table(const std::string&, const std::vector<Item>& items, const Columns&... columns) {
    if (fields::left_out_where_empty<Item> && items.empty()) return;
    add(std::uint64_t(items.size()));
    const auto add_unless = [this](bool left_out, const auto& value) {
      if (!left_out) add(value);
    };
    const auto add_rows = [&](const auto... left_out) {
      for (const Item& item : items) (add_unless(left_out, item.*columns.member), ...);
    };
    add_rows(omits_column(columns, items)...);
  }

 private:
  template <class Value>
  void add(const Value& value) {
    if constexpr (Textual<Value>) {
      const std::string text = text_of(value) + '\0';
      sum_ = crc32c(std::as_bytes(std::span(text)), sum_);
    } else {
      typename Layout<Value>::Scalar scalars[Layout<Value>::size];
      Layout<Value>::put(value, scalars);
      sum_ = crc32c(std::as_bytes(std::span(scalars)), sum_);
    }
  }

  std::uint32_t sum_ = 0;
};

}  // namespace rvelab::io
