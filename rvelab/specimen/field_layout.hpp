// The bytes of one value of a field: text, or scalars of one type in a fixed order. Snapshots and files share this
// layout. Booleans are uint8, enumerations their names, vectors and images rows of three, 3x3 matrices row-major.
// Doubles keep every bit.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/contact/model.hpp"
#include "rvelab/error.hpp"
#include "rvelab/grains/own_columns.hpp"
#include "rvelab/grains/rigid_motion.hpp"

namespace rvelab::fields {

/// Text for a value that is text or an enumeration, and the inverse (InputError listing the names).
inline std::string text_of(const std::string& value) { return value; }
template <class Enumeration>
std::string text_of(Enumeration value) {
  return name(value);
}

inline void from_text(const std::string& text, std::string& value) { value = text; }
template <class Choice>
void from_text(const std::string& text, Choice& value) {
  value = choice_from<Choice>(text);
}
inline void from_text(const std::string& text, Shape& value) {
  for (int number = 0; number < shape_count; ++number)
    if (text == name(Shape(number))) {
      value = Shape(number);
      return;
    }
  throw InputError("shape = \"" + text + "\" is not known; allowed: " + names_of_shapes([](Shape) { return true; }) +
                   "; choose one of these");
}

template <class Value>
concept Textual = std::is_enum_v<Value> || std::same_as<Value, std::string>;

/// Type of one value of a field: of an entry where the field is a list.
template <class Value>
struct Listed {
  using Entry = Value;
  static constexpr bool is_list = false;
};
template <class Value>
struct Listed<std::vector<Value>> {
  using Entry = Value;
  static constexpr bool is_list = true;
};

/// Layout of one numeric value: the scalar's type, and the extents of one value, outermost first. `in_order`: the value
/// in memory consists of its scalars in that order, so that a list of them can be copied as a whole. A long has 64 bits
/// in a file, also if it has 32 in memory (WebAssembly).
template <class Value>
struct Layout {
  static_assert(std::is_arithmetic_v<Value>);
  static constexpr bool is_long = std::is_same_v<Value, long> || std::is_same_v<Value, unsigned long>;
  using Integer = std::conditional_t<sizeof(Value) == 4 && !is_long, std::int32_t,
                                     std::conditional_t<std::is_signed_v<Value>, std::int64_t, std::uint64_t>>;
  using Scalar = std::conditional_t<std::is_same_v<Value, bool>, std::uint8_t,
                                    std::conditional_t<std::is_floating_point_v<Value>, double, Integer>>;
  static_assert(sizeof(Scalar) == sizeof(Value) || is_long);
  static constexpr std::array<std::uint64_t, 0> extents{};
  static constexpr std::size_t size = 1;
  static constexpr bool in_order = !std::is_same_v<Value, bool> && sizeof(Scalar) == sizeof(Value);
  static void put(const Value& value, Scalar* row) { row[0] = static_cast<Scalar>(value); }
  static void get(const Scalar* row, Value& value) { value = static_cast<Value>(row[0]); }
};

template <class Value, class Number>
struct RowOfThree {
  using Scalar = Number;
  static_assert(sizeof(Value) == 3 * sizeof(Number));
  static constexpr std::array<std::uint64_t, 1> extents{3};
  static constexpr std::size_t size = 3;
  static constexpr bool in_order = true;
  static void put(const Value& value, Number* row) { std::copy_n(value.data(), 3, row); }
  static void get(const Number* row, Value& value) { std::copy_n(row, 3, value.data()); }
};
template <>
struct Layout<Vector3> : RowOfThree<Vector3, double> {};
template <>
struct Layout<Image> : RowOfThree<Image, std::int32_t> {};

/// Scalar part first.
template <>
struct Layout<Turn> {
  using Scalar = double;
  static constexpr std::array<std::uint64_t, 1> extents{4};
  static constexpr std::size_t size = 4;
  static constexpr bool in_order = false;
  static void put(const Turn& value, double* row) {
    row[0] = value.w;
    std::copy_n(value.v.data(), 3, row + 1);
  }
  static void get(const double* row, Turn& value) {
    value.w = row[0];
    std::copy_n(row + 1, 3, value.v.data());
  }
};

template <>
struct Layout<Matrix3> {
  using Scalar = double;
  static constexpr std::array<std::uint64_t, 2> extents{3, 3};
  static constexpr std::size_t size = 9;
  static constexpr bool in_order = false;
  static void put(const Matrix3& value, double* row) {
    for (int k = 0; k < 9; ++k) row[k] = value(k / 3, k % 3);
  }
  static void get(const double* row, Matrix3& value) {
    for (int k = 0; k < 9; ++k) value(k / 3, k % 3) = row[k];
  }
};

}  // namespace rvelab::fields
