#include "rvelab/cli/command.hpp"

#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"

namespace rvelab::cli {
namespace {

/// The nearest of the names to a whole word, and all of them.
std::string nearest_of(const std::string& word, const std::vector<std::string>& names) {
  const bool letter = word.starts_with("-") && !word.starts_with("--");
  return (letter ? "" : "; the nearest is " + keys::nearest(word, names)) + "; allowed: " + keys::listed(names);
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> subcommands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// The first example of a subcommand's help.
std::string example_of(const CLI::App& command) {
  std::istringstream help(command.get_footer());
  for (std::string line; std::getline(help, line);)
    if (line.starts_with("  rvelab " + command.get_name())) return "; write for example: " + line.substr(2);
  return "";
}

}  // namespace

void add_json(CLI::App& command, bool& json) { command.add_flag("--json", json, "print one JSON object"); }

void add_force(CLI::App& command, bool& force, const std::string& what) {
  command.add_flag("--force", force, "overwrite " + what);
}

void add_threads(CLI::App& command, unsigned& threads, const std::string& help) {
  command.add_option("--threads", threads, help)->check(CLI::Range(1, 4096));
}

void add_set(CLI::App& command, std::vector<std::string>& settings, const std::string& example) {
  command.add_option("--set", settings, "KEY=VALUE, for example " + example + "; give it again for more")
      ->allow_extra_args(false);
}

void refuse(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const bool of_program = chosen.empty() || !app.remaining().empty();
  const CLI::App& command = of_program ? app : *chosen.front();
  const std::string of = of_program ? "" : command.get_name() + ": ";
  const std::string see = "; see rvelab " + (of_program ? "" : command.get_name() + " ") + "--help";
  // Words that nothing takes come first: CLI11 would tell what is missing for want of them.
  for (const std::string& given : command.remaining()) {
    const std::string word = given.substr(0, given.find('='));
    if (word == "--") continue;
    if (word.starts_with("-"))
      throw InputError(of + "unknown option " + word + nearest_of(word, options_of(command)) + see);
    if (of_program) throw InputError("unknown subcommand " + word + nearest_of(word, subcommands_of(app)) + see);
  }
  throw InputError(of + error.what() + example_of(command) + see);
}

}  // namespace rvelab::cli
