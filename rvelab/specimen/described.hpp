// Structs described member by member, once for all files of their values, with a check that the description is
// complete. The description of a struct is a specialisation of members_of:
//
//     template <>
//     inline constexpr auto members_of<Cell> = std::tuple{Field{"lattice_m", &Cell::lattice, "m"}, ...};
//
// It is complete if it has as many entries as the struct has members and no two of them are the same member. The first
// is checked by the number of initialisers of the aggregate, the second by comparing the pointers to members: a new
// member without a description, or a repeated description, does not compile.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "rvelab/specimen/field_layout.hpp"

namespace rvelab::fields {

/// Entries of a field: one value, or a list with one for each grain. In a table each column has one for each row.
/// `per_grain_or_left_out`: a file has no dataset for an empty list.
enum class Rows { one, per_grain, per_grain_or_none, per_grain_or_left_out };

/// Direction of the vectors of a field in 2D: any, in the plane (z = 0), along its normal (x = y = 0), or one component
/// along the tangent of a contact (y = z = 0).
enum class InPlane { any, along, normal, tangent };

/// One member: its name in a file, its unit ("1" for a pure number, "-" for text) and its range: finite numbers in this
/// range, for vectors and matrices each component. Conditions between fields are in specimen_check.cpp, body_check.cpp
/// and interaction_check.cpp.
template <class Owner, class Value>
struct Field {
  const char* name;
  Value Owner::*member;
  const char* units;
  Rows rows = Rows::one;
  Interval allowed{-no_bound, no_bound};
  InPlane plane = InPlane::any;
  bool left_out_at_zero = false;  ///< of a table: a file has no dataset where all rows are zero

  constexpr Field within(Interval range) const {
    Field stated = *this;
    stated.allowed = range;
    return stated;
  }
  constexpr Field lying(InPlane how) const {
    Field stated = *this;
    stated.plane = how;
    return stated;
  }
};
template <class Owner, class Value, class... More>
Field(const char*, Value Owner::*, const char*, More...) -> Field<Owner, Value>;

/// A member that is a struct with a description of its own; in a file it is a group.
template <class Owner, class Value>
struct Part {
  const char* name;
  Value Owner::*member;
};
template <class Owner, class Value>
Part(const char*, Value Owner::*) -> Part<Owner, Value>;

/// A member that is a list of structs, each described by fields; in a file it is a group with one dataset a field.
template <class Owner, class Item>
struct Table {
  const char* name;
  std::vector<Item> Owner::*member;
};
template <class Owner, class Item>
Table(const char*, std::vector<Item> Owner::*) -> Table<Owner, Item>;

/// Whether a file omits an empty table of these.
template <class Item>
inline constexpr bool left_out_where_empty = false;

/// The description of a struct, a tuple of Field, Part and Table in the order of the file.
template <class Struct>
inline constexpr std::tuple<> members_of{};

/// Name of a field with those of its parts, "state/energy_balance/friction_J". Composed only on request: a snapshot
/// does not need it.
class Path {
 public:
  Path(const Path* within, const char* name) : within_(within), name_(name) {}
  std::string text() const { return within_ == nullptr ? name_ : within_->text() + "/" + name_; }

 private:
  const Path* within_;
  const char* name_;
};

/// Converts to any initialiser.
struct AnyValue {
  template <class Value>
  operator Value() const;
};

/// Number of members of an aggregate: its largest number of initialisers. (An array declared as T[n] would count as n.)
template <class Struct, class... Given>
consteval std::size_t member_count() {
  static_assert(std::is_aggregate_v<Struct>, "only the members of an aggregate can be counted");
  if constexpr (requires { Struct{Given{}..., AnyValue{}}; }) {
    return member_count<Struct, Given..., AnyValue>();
  } else {
    return sizeof...(Given);
  }
}

/// Number of inherited members of a struct, minus one initialiser for each base.
template <class Struct>
inline constexpr std::size_t inherited_members = 0;

template <class A, class B>
constexpr bool are_distinct(const A& a, const B& b) {
  if (std::string_view(a.name) == b.name) return false;
  if constexpr (std::is_same_v<decltype(a.member), decltype(b.member)>) return a.member != b.member;
  return true;
}

constexpr bool all_distinct() { return true; }
template <class First, class... Rest>
constexpr bool all_distinct(const First& first, const Rest&... rest) {
  return (are_distinct(first, rest) && ...) && all_distinct(rest...);
}

/// Parts and tables do not declare rows.
constexpr bool says_its_rows(const auto&) { return true; }
template <class Owner, class Value>
constexpr bool says_its_rows(const Field<Owner, Value>& field) {
  return Listed<Value>::is_list == (field.rows != Rows::one);
}

/// Whether each member of the struct is described once, under a unique name.
template <class Struct>
consteval bool describes_every_member() {
  return std::apply(
      [](const auto&... each) {
        return sizeof...(each) == member_count<Struct>() + inherited_members<Struct> && all_distinct(each...) &&
               (says_its_rows(each) && ...);
      },
      members_of<Struct>);
}

template <class Archive, class Struct>
void visit(Archive& archive, Struct& owner, const Path* within = nullptr);

template <class Archive, class Struct, class Owner, class Value>
void visit_member(Archive& archive, Struct& owner, const Path* within, const Field<Owner, Value>& field) {
  archive.field(Path(within, field.name), owner.*field.member, field);
}

template <class Archive, class Struct, class Owner, class Value>
void visit_member(Archive& archive, Struct& owner, const Path* within, const Part<Owner, Value>& part) {
  const Path path(within, part.name);
  visit(archive, owner.*part.member, &path);
}

template <class Archive, class Struct, class Owner, class Item>
void visit_member(Archive& archive, Struct& owner, const Path* within, const Table<Owner, Item>& table) {
  static_assert(describes_every_member<Item>(), "a member is not described: add it to members_of of this struct");
  std::apply([&](const auto&... columns) { archive.table(Path(within, table.name), owner.*table.member, columns...); },
             members_of<Item>);
}

/// Shows every field of a struct, const or not, to an archive, in the order of the description:
///
///     archive.field(path, value, field);          // a value or a list of values, and its Field
///     archive.table(path, items, columns...);     // a list of structs, and the Fields of one
template <class Archive, class Struct>
void visit(Archive& archive, Struct& owner, const Path* within) {
  using Plain = std::remove_const_t<Struct>;
  static_assert(describes_every_member<Plain>(), "a member is not described: add it to members_of of this struct");
  std::apply([&](const auto&... each) { (visit_member(archive, owner, within, each), ...); }, members_of<Plain>);
}

}  // namespace rvelab::fields
