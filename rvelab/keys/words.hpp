// Enumerations by their names, as TOML and files of records and specimens write them.
#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "rvelab/contact/model.hpp"
#include "rvelab/error.hpp"
#include "rvelab/grains/shape.hpp"

namespace rvelab::keys {

/// The word for a value that is text or an enumeration, and the way back (InputError listing the names).
inline std::string text_of(const std::string& value) { return value; }
inline std::string text_of(Shape shape) { return shape == Shape::disc ? "disc" : "sphere"; }
template <class Enumeration>
std::string text_of(Enumeration value) {
  return name(value);
}

inline void from_text(const std::string& text, std::string& value) { value = text; }
inline void from_text(const std::string& text, Law& value) { value = law_from(text); }
inline void from_text(const std::string& text, Slip& value) { value = slip_from(text); }
inline void from_text(const std::string& text, Dashpot& value) { value = dashpot_from(text); }
inline void from_text(const std::string& text, LocalDampingForm& value) { value = local_damping_form_from(text); }
inline void from_text(const std::string& text, Shape& value) {
  if (text != "disc" && text != "sphere") {
    throw InputError("shape = \"" + text + "\" is not known; allowed: disc, sphere; choose one of these");
  }
  value = text == "disc" ? Shape::disc : Shape::sphere;
}

template <class Value>
concept Textual = std::is_enum_v<Value> || std::same_as<Value, std::string>;

}  // namespace rvelab::keys
