// rvelab protocols: the tests that are installed with the program.
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>

#include "rvelab/cli/commands.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/report.hpp"

namespace rvelab::cli {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream input(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), {}};
}

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
  Listing listing;
  if (!name.empty()) {
    const std::string path = protocol_path(name), text = text_of(path);
    if (!json) {
      std::cout << text << std::flush;
      return;
    }
    listing.add("file", path);
    listing.add("text", text);
    return listing.print(true);
  }
  for (const auto& [installed, path] : installed_protocols()) listing.add(installed, first_sentence(text_of(path)));
  listing.print(json);
}

}  // namespace

void add_protocols(CLI::App& app) {
  struct Arguments {
    std::string name;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("protocols", "List the tests that come with rvelab, or print one");
  command->add_option("name", arguments->name, "print this one");
  command->add_flag("--json", arguments->json, "print one JSON object");
  command->footer(
      "Examples:\n"
      "  rvelab protocols\n"
      "  rvelab protocols biaxial > mine.toml");
  command->callback([arguments] { run_protocols(arguments->name, arguments->json); });
}

}  // namespace rvelab::cli
