#include "rvelab/cli/mistakes.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/keys/key.hpp"

namespace rvelab::cli {
namespace {

using Apps = std::vector<const CLI::App*>;

Apps subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

[[noreturn]] void refuse_option(const CLI::App& command, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    if (option->get_lnames().empty()) {
      for (const auto& name : option->get_snames()) names.push_back("-" + name);
    }
  }
  const bool is_main = command.get_parent() == nullptr;
  const std::string help = is_main ? "rvelab --help" : "rvelab " + command.get_name() + " --help";
  throw InputError((is_main ? "" : command.get_name() + ": ") + std::string("unknown option ") + word +
                   (word.starts_with("--") ? "; the nearest is " + keys::nearest(word, names) : "") +
                   "; allowed: " + joined(names) + "; see " + help);
}

/// -1.5 and -.5 are values.
bool is_number(const std::string& word) {
  return word.size() > 1 && (std::isdigit(static_cast<unsigned char>(word[1])) != 0 || word[1] == '.');
}

/// The options of one command, from argv[first] on.
void expect_known_options(const CLI::App& command, int first, int argc, const char* const* argv) {
  for (int k = first; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--") return;
    if (word.size() < 2 || word[0] != '-' || is_number(word)) continue;
    const bool is_long = word[1] == '-';
    const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
    const CLI::Option* option = command.get_option_no_throw(name);
    if (option == nullptr) refuse_option(command, name);
    const bool has_value_in_it = is_long ? word.find('=') != std::string::npos : word.size() > 2;
    if (!has_value_in_it) k += option->get_items_expected_min();  // the words that follow are its values
  }
}

const CLI::App* chosen(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? nullptr : parsed.front();
}

/// The first example of a command's help.
std::string example_of(const CLI::App& command) {
  std::istringstream footer(command.get_footer());
  const std::string start = "  rvelab " + command.get_name();
  for (std::string line; std::getline(footer, line);) {
    if (line.starts_with(start)) return line.substr(2);
  }
  return "";
}

}  // namespace

void expect_known_words(const CLI::App& app, int argc, const char* const* argv) {
  if (argc < 2) return;
  const std::string word = argv[1];
  if (word.starts_with("-")) return expect_known_options(app, 1, argc, argv);
  std::vector<std::string> names;
  for (const CLI::App* command : subcommands(app)) {
    if (command->get_name() == word) return expect_known_options(*command, 2, argc, argv);
    names.push_back(command->get_name());
  }
  throw InputError("unknown subcommand " + word + "; the nearest is " + keys::nearest(word, names) +
                   "; allowed: " + joined(names) + "; see rvelab --help");
}

std::string with_remedy(const CLI::App& app, const CLI::Error& error) {
  const CLI::App* command = chosen(app);
  if (command == nullptr) return std::string(error.what()) + "; see rvelab --help";
  const std::string example = example_of(*command);
  return command->get_name() + ": " + error.what() + (example.empty() ? "" : "; write for example: " + example) +
         "; see rvelab " + command->get_name() + " --help";
}

}  // namespace rvelab::cli
