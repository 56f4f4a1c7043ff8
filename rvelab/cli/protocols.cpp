// rvelab protocols: the tests and the recipes that are installed with the program. Declared in command.hpp.
#include <iostream>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/keys/regular_file.hpp"

namespace rvelab::cli {
namespace {

std::string text_of(const std::string& path) { return keys::whole_file<std::string>(path, "a protocol or a recipe"); }

/// The first sentence of the comment that a protocol opens with.
std::string first_sentence(const std::string& text) {
  std::string sentence;
  for (std::size_t begin = 0; begin < text.size() && text[begin] == '#';) {
    const auto end = std::min(text.find('\n', begin), text.size());
    auto first = text.find_first_not_of("# ", begin);
    if (first == std::string::npos || first >= end) break;
    sentence += (sentence.empty() ? "" : " ") + text.substr(first, end - first);
    begin = end + 1;
  }
  const auto stop = sentence.find_first_of(".:");
  return sentence.substr(0, stop);
}

void run_protocols(const std::string& name, bool json) {
  expect_installed();
  Listing listing;
  if (!name.empty()) {
    const bool recipe = installed(InputKind::recipe).contains(name);
    const std::string path = input_path(name, recipe ? InputKind::recipe : InputKind::protocol), text = text_of(path);
    if (!json) {
      std::cout << text << std::flush;
      return;
    }
    listing.add("file", path);
    listing.add("text", text);
    return listing.print(true);
  }
  const auto add = [](Listing& to, InputKind kind) {
    for (const auto& [each, path] : installed(kind)) to.add(each, first_sentence(text_of(path)));
  };
  add(listing, InputKind::protocol);
  Listing recipes;
  add(json ? listing : recipes, InputKind::recipe);
  listing.print(json);
  if (!json && !recipes.empty()) std::cout << "\nRecipes, for rvelab pack:\n" << recipes.text() << std::flush;
}

}  // namespace

void add_protocols(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("protocols", "List the tests and recipes that come with rvelab, or print one");
  const auto name = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>();
  command.add_option("name", *name, "print this one");
  add_json(command, *json);
  command.footer(
      "Examples:\n"
      "  rvelab protocols\n"
      "  rvelab protocols biaxial > mine.toml\n"
      "  rvelab protocols pack_dense > recipe.toml");
  command.callback([name, json] { run_protocols(*name, *json); });
}

}  // namespace rvelab::cli
