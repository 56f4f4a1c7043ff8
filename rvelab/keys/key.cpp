#include "rvelab/keys/key.hpp"

#include <algorithm>
#include <numeric>

#include "rvelab/error.hpp"
#include "rvelab/keys/edit_distance.hpp"
#include "rvelab/keys/toml_source.hpp"

namespace rvelab::keys {
namespace {

bool is_assigned(const toml::source_region& place) { return place.path && place.path->starts_with(assignment_prefix); }

}  // namespace

std::string Key::allowed() const {
  const bool has_unit = unit != "-" && unit != "1";
  return range + (has_unit ? " " + unit : "");
}

const toml::source_region& place_of(const toml::key& key, const toml::node& value) {
  return is_assigned(value.source()) ? value.source() : key.source();
}

KeyError key_error(const toml::source_region& place, const std::string& message) {
  if (is_assigned(place)) return {0, *place.path + ": " + message, true};
  return {static_cast<long>(place.begin.line), message};
}

toml::table parsed_value(const std::string& text, const std::string& assignment) {
  const std::string source = assignment_prefix + assignment;
  try {
    toml::table parsed = parse_toml("value = " + text, source);
    if (parsed.size() == 1) return parsed;
  } catch (const toml::parse_error&) {
    // a bare word
  }
  // As a TOML literal, so that the word too comes out of a parse and knows where it is from.
  const bool quotable = text.find_first_of("'\n\r") == std::string::npos;
  try {
    if (quotable) return parse_toml("value = '" + text + "'", source);
  } catch (const toml::parse_error&) {
    // control characters
  }
  return toml::table{{"value", text}};
}

double number_in(const toml::node& node) {
  // toml++ gives no double for a whole number that it would have to round.
  return node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
}

std::size_t edit_distance(const std::string& word, const std::string& candidate) {
  std::vector<std::size_t> row(candidate.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= word.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= candidate.size(); ++j) {
      const std::size_t changed = diagonal + (word[i - 1] == candidate[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  std::size_t least = 4 * row.back();
  for (std::size_t j = 0; j < candidate.size(); ++j) least = std::min(least, 4 * row[j] + candidate.size() - j);
  return least;
}

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  const auto distance = [&](const std::string& candidate) { return edit_distance(word, candidate); };
  const auto found = std::min_element(candidates.begin(), candidates.end(),
                                      [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  return found == candidates.end() ? "" : *found;
}

std::string choose_one(const std::string& word, const std::vector<std::string>& choices) {
  return "the nearest is " + nearest(word, choices) + "; choose one of these";
}

void raise(const std::string& path, std::vector<KeyError> errors) {
  if (errors.empty()) return;
  const auto order = [](const KeyError& error) { return std::pair(error.assigned, error.line); };
  std::stable_sort(errors.begin(), errors.end(), [&](const auto& a, const auto& b) { return order(a) < order(b); });
  std::string text;
  for (const auto& error : errors) {
    const std::string place = error.line > 0 ? ":" + std::to_string(error.line) : "";
    text += (text.empty() ? "" : "\n") + path + place + ": " + error.message;
  }
  throw InputError(text);
}

toml::table parse_toml_file(const std::string& path) {
  return parse_toml_text(whole_file<std::string>(path, "a TOML file", 16 << 20), path);
}

toml::table parse_toml_text(const std::string& text, const std::string& path) {
  try {
    return parse_toml(text, path);
  } catch (const toml::parse_error& error) {
    const auto& begin = error.source().begin;
    throw InputError(path + ":" + std::to_string(begin.line) + ": column " + std::to_string(begin.column) +
                     ": is not TOML (" + std::string(error.description()) + "); correct the line");
  }
}

}  // namespace rvelab::keys
