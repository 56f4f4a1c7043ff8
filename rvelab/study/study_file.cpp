// The file of a study. Declared in study.hpp.
#include <algorithm>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/study/study.hpp"

namespace rvelab::study {
namespace {

/// A node as what stands behind "=" in an assignment.
std::string as_value(const toml::node& node) {
  return node.is_string() ? node.as_string()->get() : keys::written(node);
}

std::vector<Variation> read_grid(const toml::table& file, std::vector<keys::KeyError>& errors) {
  std::vector<Variation> grid;
  const toml::node* node = file.get("vary");
  if (node == nullptr) return grid;
  if (!node->is_array_of_tables()) {
    errors.push_back(
        keys::key_error(node->source(), "vary is no list of tables; allowed: [[vary]] with key and values"));
    return grid;
  }
  for (const toml::node& item : *node->as_array()) {
    const toml::table& table = *item.as_table();
    const std::vector<std::string> known{"key", "values"};
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      if (name != "key" && name != "values")
        errors.push_back(keys::key_error(key.source(), "unknown key vary." + name + "; the nearest known key is vary." +
                                                           keys::nearest(name, known) +
                                                           "; correct the name or remove it"));
    }
    Variation one{table["key"].value_or(std::string()), {}};
    if (const toml::array* values = table["values"].as_array()) {
      for (const toml::node& value : *values) one.values.push_back(as_value(value));
    }
    std::vector<std::string> sorted = one.values;
    std::sort(sorted.begin(), sorted.end());
    const bool twice = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
    const bool blank = std::find(sorted.begin(), sorted.end(), "") != sorted.end();
    if (one.key.empty() || one.values.empty() || twice || blank) {
      errors.push_back(keys::key_error(table.source(),
                                       "vary needs a key and values, each once; allowed: key = \"TABLE.KEY\" "
                                       "and values = [v1, v2]; correct them"));
    }
    grid.push_back(one);
  }
  return grid;
}

toml::array as_array(const std::vector<std::string>& texts) {
  toml::array list;
  for (const std::string& text : texts) list.push_back(text);
  return list;
}

}  // namespace

bool is_study(const toml::table& file) { return file.contains("study"); }

Study read_study(const toml::table& file, const std::string& path) {
  std::vector<keys::KeyError> errors;
  keys::expect_top_tables(file, errors, {"study", "vary"});
  const toml::table& table = keys::table_of(file, "study", errors);
  keys::TableReader reader(table, "study", "study", keys::line_of(table), errors);
  Study study;
  reader.text("protocol", study.protocol, "protocol, or the name of an installed one");
  reader.text("protocol_text", study.protocol_text, "the protocol itself");
  reader.text("made_with", study.made_with, "version of the program that wrote the file");
  reader.whole_number("repeats", study.repeats, {0, 10'000}, "whole paths a grid point and specimen");
  reader.whole_number("increments", study.increments, {0, 1e6}, "increments a grid point and specimen");
  reader.number("relax_unbalanced", study.relaxation.unbalanced, "1", keys::ratio,
                "unbalanced force ratio that the reference's answers are relaxed to");
  reader.whole_number("relax_max_steps", study.relaxation.max_steps, keys::steps, "sub-steps of that");
  if (study.protocol.empty() == study.protocol_text.empty()) {
    reader.mistake("protocol",
                   "and study.protocol_text: exactly one of them names the test; allowed: protocol = \"biaxial\", the "
                   "path of a file, or the text of one; give one");
  }
  study.specimens = reader.texts("specimens", "files, relative to the folder of the study");
  study.digests = reader.texts("digests", "of the specimens");
  study.settings = reader.texts("settings", "KEY=value of every run");
  study.reference = reader.texts("reference", "KEY=value of the best-resolved run");
  reader.finish();
  study.grid = read_grid(file, errors);
  keys::raise(path, errors);
  return study;
}

std::string written(const Study& study) {
  toml::table table;
  if (!study.protocol.empty()) table.insert("protocol", study.protocol);
  if (!study.protocol_text.empty()) table.insert("protocol_text", study.protocol_text);
  if (!study.made_with.empty()) table.insert("made_with", study.made_with);
  table.insert("specimens", as_array(study.specimens));
  if (!study.digests.empty()) table.insert("digests", as_array(study.digests));
  table.insert("settings", as_array(study.settings));
  table.insert("reference", as_array(study.reference));
  table.insert("repeats", study.repeats);
  table.insert("increments", study.increments);
  table.insert("relax_max_steps", study.relaxation.max_steps);
  toml::table file;
  file.insert("study", table);
  toml::array grid;
  for (const Variation& one : study.grid) {
    grid.push_back(toml::table{{"key", one.key}, {"values", as_array(one.values)}});
  }
  if (!grid.empty()) file.insert("vary", grid);
  std::string written = keys::written_file(file);
  // By hand: the library writes 17 digits of every number.
  const std::string head = "[study]\n";
  written.insert(written.find(head) + head.size(),
                 "relax_unbalanced = " + keys::written(toml::value<double>(study.relaxation.unbalanced)) + "\n");
  return "# A study of rvelab: `rvelab study` on this file runs it again.\n" + written;
}

}  // namespace rvelab::study
