// rvelab keys: every key of protocols, recipes and material files. Declared in command.hpp.
#include <algorithm>
#include <cctype>
#include <iostream>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/error.hpp"
#include "rvelab/protocol/protocol.hpp"

namespace rvelab::cli {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return text;
}

/// Keys whose dotted name holds the pattern, whatever its case.
std::vector<keys::Key> keys_with(const std::string& pattern) {
  std::vector<keys::Key> found;
  std::vector<std::string> names;
  for (const keys::Key& key : protocol::all_keys()) {
    names.push_back(key.dotted());
    if (lower(key.dotted()).find(lower(pattern)) != std::string::npos) found.push_back(key);
  }
  if (found.empty()) {
    const std::string near = keys::near_one(pattern, names);
    throw InputError("no key holds \"" + pattern + "\"" + (near.empty() ? "" : "; the nearest known key is " + near) +
                     "; give a part of a key, or none to see all");
  }
  return found;
}

Json as_json(const keys::Key& key) {
  Json json;
  json["key"] = key.dotted();
  json["table"] = key.table;
  json["name"] = key.name;
  json["unit"] = key.unit;
  json["type"] = key.type;
  json["required"] = key.required;
  json["default"] = key.initial.empty() ? Json() : Json(key.initial);
  json["range"] = key.range;
  json["usual"] = key.usual.is_stated() ? Json(keys::usual_in_words(key)) : Json();
  json["meaning"] = key.meaning;
  return json;
}

/// Two lines: the allowed values, and the meaning.
std::string as_text(const keys::Key& key) {
  const std::string unit = key.unit == "1" || key.unit == "-" ? "" : " in " + key.unit;
  const std::string initial = key.required ? "required" : key.initial.empty() ? "no default" : "default " + key.initial;
  const std::string usual = key.usual.is_stated() ? "; usual " + keys::usual_in_words(key) : "";
  return key.dotted() + "  (" + key.type + unit + ": " + key.range + usual + "; " + initial + ")\n    " + key.meaning +
         "\n";
}

void run_keys(const std::string& pattern, bool json) {
  const auto keys = keys_with(pattern);
  if (json) {
    Listing listing;
    Json list = Json::array();
    for (const keys::Key& key : keys) list.push_back(as_json(key));
    listing.add("keys", list);
    return listing.print(true);
  }
  std::string text;
  for (const keys::Key& key : keys) text += as_text(key);
  std::cout << text << std::flush;
}

}  // namespace

void add_keys(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("keys", "List the keys of protocols, recipes and material files");
  const auto pattern = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>();
  command.add_option("pattern", *pattern, "part of a key, for example pressure or stage.compression");
  add_json(command, *json);
  command.footer(
      "A key of a stage is below [[stage]] with that kind in a file; with --set it is stage.NAME.key. A key of\n"
      "[material] is material.key for all materials, material.NAME.key for one.\n\n"
      "Examples:\n"
      "  rvelab keys stage.compression\n"
      "  rvelab keys pressure --json");
  command.callback([pattern, json] { run_keys(*pattern, *json); });
}

}  // namespace rvelab::cli
