#include "rvelab/keys/key.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>

#include "rvelab/error.hpp"
#include "rvelab/keys/edit_distance.hpp"
#include "rvelab/keys/file_format.hpp"
#include "rvelab/keys/shortened.hpp"
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
  return {long(place.begin.line), message};
}

toml::table parsed_value(const std::string& text, const std::string& assignment) {
  const std::string source = assignment_prefix + shortened(assignment, 200);
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
  return node.is_integer() ? double(node.as_integer()->get()) : node.as_floating_point()->get();
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

std::string near_one(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string found = nearest(word, candidates);
  if (!found.empty() && edit_distance(word, found) < 2 * word.size()) return found;
  constexpr std::size_t of_a_word = 4;  // letters: shorter ones are in many names
  if (word.size() < of_a_word) return "";
  const auto holds_it = [&](const std::string& candidate) {
    return ("_" + candidate + "_").find("_" + word + "_") != std::string::npos;
  };
  const auto place = std::find_if(candidates.begin(), candidates.end(), holds_it);
  return place == candidates.end() ? "" : *place;
}

std::string nearest_in_words(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string near = near_one(word, candidates);
  return near.empty() ? "" : "; the nearest is " + near;
}

std::string what_was_meant(const std::string& prefix, const std::string& word, const std::vector<std::string>& known) {
  const std::string correct = "; correct the name or remove it";
  const std::string near = near_one(word, known);
  if (!near.empty()) return "the nearest known key is " + prefix + near + correct;
  const std::vector<std::string> of_recipes{"pack", "grains", "target", "preparation"}, of_tests{"test", "stage"};
  const auto is_one_of = [&](const auto& tables) {
    return prefix.empty() && std::find(tables.begin(), tables.end(), word) != tables.end();
  };
  if (is_one_of(of_recipes)) return "it is of recipes, for rvelab pack; set it there, or remove it";
  if (is_one_of(of_tests)) return "it is of tests, for rvelab run; set it there, or remove it";
  if (known.size() > 16) return "no known key is near; rvelab keys lists them" + correct;
  std::string all;
  for (const std::string& name : known) all += (all.empty() ? "" : ", ") + prefix + name;
  return "allowed: " + all + correct;
}

std::string choose_one(const std::string& word, const std::vector<std::string>& choices) {
  const std::string near = near_one(word, choices);
  return (near.empty() ? "" : "the nearest is " + near + "; ") + "choose one of these";
}

std::size_t mistakes_in(const std::vector<KeyError>& errors) {
  return std::size_t(std::count_if(errors.begin(), errors.end(), [](const KeyError& error) { return !error.doubt; }));
}

std::vector<std::string> doubts_in(const std::vector<KeyError>& errors) {
  std::vector<std::string> doubts;
  for (const KeyError& error : errors) {
    const bool known = std::any_of(doubts.begin(), doubts.end(), [&](const std::string& doubt) {
      return key_of_doubt(doubt) == key_of_doubt(error.message);
    });
    if (error.doubt && !known) doubts.push_back(error.message);
  }
  return doubts;
}

std::string key_of_doubt(const std::string& doubt) {
  const auto equals = doubt.find(" = ");
  if (equals == std::string::npos) return doubt;
  const auto begin = doubt.rfind(' ', equals - 1);  // npos + 1 = 0
  return doubt.substr(begin + 1, equals - begin - 1);
}

std::string with_doubts(const std::vector<std::string>& doubts, const std::string& text) {
  std::string comments;
  for (const std::string& doubt : doubts) comments += "# " + shortened(doubt, 400) + "\n";
  return comments + text;
}

void raise(const std::string& path, std::vector<KeyError> errors) {
  std::erase_if(errors, [](const KeyError& error) { return error.doubt; });
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
    if (const FileFormat* format = format_of(text))
      throw InputError(path + ": is " + format->what + ", not TOML; give the path of a TOML file");
    const auto& begin = error.source().begin;
    throw InputError(path + ":" + std::to_string(begin.line) + ": column " + std::to_string(begin.column) +
                     ": is not TOML (" + std::string(error.description()) + "); correct the line");
  }
}

namespace {

/// "a.b.c" into its parts.
std::vector<std::string> parts_of(const std::string& key) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= key.size();) {
    const auto end = std::min(key.find('.', begin), key.size());
    parts.push_back(trimmed(key.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

std::string name_of(const toml::node& item) {
  const toml::table* table = item.as_table();
  if (table == nullptr) return "";
  return (*table)["name"].value_or(std::string((*table)["kind"].value_or("")));
}

/// One table of a list, by its name (a stage without one: its kind) or its number from 0.
toml::table& find_in(toml::array* items, const std::string& list, const std::string& which,
                     const std::string& assignment) {
  std::string known;
  std::vector<toml::table*> found;
  if (items != nullptr) {
    std::size_t wanted = items->size();
    const auto [end, error] = std::from_chars(which.data(), which.data() + which.size(), wanted);
    const bool by_number = error == std::errc() && end == which.data() + which.size();
    for (std::size_t k = 0; k < items->size(); ++k) {
      toml::node& item = *items->get(k);
      const std::string name = name_of(item);
      known += (known.empty() ? "" : ", ") + std::to_string(k) + (name.empty() ? "" : " (" + name + ")");
      if (item.is_table() && (by_number ? wanted == k : name == which)) found.push_back(item.as_table());
    }
  }
  if (found.size() == 1) return *found[0];
  throw InputError("--set " + assignment + " names " + (found.empty() ? "no " : "several of ") + list +
                   "; allowed: " + (known.empty() ? "none, since the file has no [[" + list + "]]" : known) +
                   "; give the name or the number of one");
}

/// Puts the value of an assignment into a table, in place of what is there.
void put(toml::table& table, const std::string& key, const std::string& text, const std::string& assignment) {
  // Of two keys for one quantity the assigned one stands.
  if (key == "friction") table.erase("friction_angle_deg");
  if (key == "friction_angle_deg") table.erase("friction");
  // A node that is moved keeps its source, so that a mistake in it names the assignment.
  toml::table value = parsed_value(text, assignment);
  toml::node& node = *value.get("value");
  const toml::source_region source = node.source();
  node.visit([&](auto& concrete) { table.insert_or_assign(toml::key(key, source), std::move(concrete)); });
}

/// Applies one assignment to a parsed file. InputError if it has no value, or names no table that is there.
void assign(toml::table& file, const std::string& assignment, std::size_t least_names) {
  const auto equals = assignment.find('=');
  const std::string key = trimmed(assignment.substr(0, equals));
  const auto parts = parts_of(key);
  const bool incomplete = parts.size() < least_names || parts.size() > most_names ||
                          std::find(parts.begin(), parts.end(), "") != parts.end();
  if (equals == std::string::npos || trimmed(assignment.substr(equals + 1)).empty() || incomplete) {
    throw InputError(
        "--set " + shortened(assignment) +
        " is not an assignment; allowed: table.key=value, of up to 8 names; write for example test.pressure_Pa=2e4");
  }
  const std::string text = trimmed(assignment.substr(equals + 1));
  toml::table* table = &file;
  std::size_t next = 0;
  if (parts[0] == "stage") {
    if (parts.size() < 3) {
      throw InputError("--set " + assignment +
                       " names no key of a stage; allowed: stage.NAME.key=value; write for example "
                       "stage.compression.to_strain=0.05");
    }
    table = &find_in(file["stage"].as_array(), "stage", parts[1], assignment);
    next = 2;
  }
  for (; next + 1 < parts.size(); ++next) {
    if (!table->contains(parts[next])) {  // made by a parse, so that it knows the assignment
      put(*table, parts[next], "{}", assignment);
      table->get(parts[next])->as_table()->is_inline(false);
    }
    toml::node* inner = table->get(parts[next]);
    if (inner->is_array_of_tables() && next + 2 < parts.size()) {
      table = &find_in(inner->as_array(), parts[next], parts[next + 1], assignment);
      ++next;
      continue;
    }
    if (inner->is_array_of_tables() && parts[next] == "material") {  // material.key: all of them
      for (toml::node& material : *inner->as_array()) put(*material.as_table(), parts.back(), text, assignment);
      return;
    }
    if (inner->is_array_of_tables()) {  // the only one, or none is named
      toml::array& all = *inner->as_array();
      table = all.size() == 1 ? all[0].as_table() : &find_in(&all, parts[next], parts[next + 1], assignment);
      continue;
    }
    if (!inner->is_table()) {
      throw InputError("--set " + assignment + ": " + parts[next] +
                       " is no table in the file; allowed: table.key=value; correct the key");
    }
    table = inner->as_table();
  }
  put(*table, parts.back(), text, assignment);
}

}  // namespace

void assign_all(toml::table& file, const std::vector<std::string>& assignments, std::vector<KeyError>& errors,
                std::size_t least_names) {
  for (const std::string& assignment : assignments) {
    try {
      assign(file, assignment, least_names);
    } catch (const InputError& error) {
      errors.push_back({0, error.what(), true});
    }
  }
}

}  // namespace rvelab::keys
