// How entries of a table of keys are written down, in any room that has one.
#pragma once

#include <limits>
#include <sstream>

#include "rvelab/keys/enumerations.hpp"
#include "rvelab/keys/table_key.hpp"

namespace rvelab::keys {

using Choices = std::vector<std::string>;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr Interval any{0, 0};
inline constexpr Interval every{-infinity, infinity, true, true};
inline constexpr Interval positive{0, infinity, true, true};
inline constexpr Interval not_negative{0, infinity, false, true};
inline constexpr Interval ratio{0, 1, true, true};
inline constexpr Interval below_one{0, 1, false, true};
inline constexpr Interval steps{1, 1e12};
/// Of pressures that grains are brought to, Pa: beyond any solid's stiffness, and squares of forces would overflow.
inline constexpr Interval pressures{0, 1e15, true, false};

inline std::string as_toml(double value) {
  std::ostringstream text;
  text.precision(15);
  text << value;
  return text.str();
}
inline std::string as_toml(long value) { return std::to_string(value); }
inline std::string as_toml(bool value) { return value ? "true" : "false"; }
template <class Text>
std::string as_toml(const Text& value) {
  return "\"" + text_of(value) + "\"";
}

// The default is that of the struct that the key fills: it is written nowhere twice.

inline TableKey number(const char* table, const char* name, const char* unit, double initial, const Interval& range,
                       const char* meaning) {
  return {
      {table, name, unit, "number", as_toml(initial), in_words(range), meaning}, KeyKind::number, range, {}, initial};
}

/// Without a default of its own; `initial` says in words what holds instead, "" if nothing does.
inline TableKey number(const char* table, const char* name, const char* unit, const char* initial,
                       const Interval& range, const char* meaning) {
  return {{table, name, unit, "number", initial, in_words(range), meaning}, KeyKind::number, range, {}, {}};
}

inline TableKey whole_number(const char* table, const char* name, long initial, const Interval& range,
                             const char* meaning) {
  return {{table, name, "1", "whole number", as_toml(initial), in_words(range), meaning},
          KeyKind::whole_number,
          range,
          {},
          initial};
}

inline TableKey boolean(const char* table, const char* name, bool initial, const char* meaning) {
  return {{table, name, "-", "boolean", as_toml(initial), "true, false", meaning}, KeyKind::boolean, any, {}, initial};
}

inline TableKey text(const char* table, const char* name, const char* initial, const char* meaning) {
  return {{table, name, "-", "text", initial, "any text", meaning}, KeyKind::text, any, {}, {}};
}

/// The first choice is the default, unless `initial` says something else in words.
inline TableKey choice(const char* table, const char* name, const Choices& choices, const char* meaning,
                       const char* initial = nullptr) {
  std::string allowed;
  for (const auto& each : choices) allowed += (allowed.empty() ? "" : ", ") + each;
  // Member by member: of a list in braces gcc 12 frees the texts twice if memory runs out on the way.
  TableKey key;
  key.key.table = table;
  key.key.name = name;
  key.key.unit = "-";
  key.key.type = "choice";
  key.key.range = allowed;
  key.key.meaning = meaning;
  key.kind = KeyKind::choice;
  key.range = any;
  key.choices = choices;
  if (initial == nullptr) {
    key.initial = choices.front();
    key.key.initial = as_toml(choices.front());
  } else {
    key.key.initial = initial;
  }
  return key;
}

inline TableKey required(TableKey key) {
  key.key.required = true;
  return key;
}

inline TableKey with_range(TableKey key, const char* words) {
  key.key.range = words;
  return key;
}

/// Without a default: what is left out is empty, or not asked for.
inline TableKey listed(const char* table, const char* name, const char* unit, const char* type, const char* allowed,
                       KeyKind kind, const char* meaning) {
  return {{table, name, unit, type, "", allowed, meaning}, kind, every, {}, {}};
}

inline constexpr const char* symmetric_components = "xx, yy, zz, yz, xz, xy = numbers";

}  // namespace rvelab::keys
