// The words of a command line, read into the subcommand that they name. The one file that knows CLI11. Declared in
// command.hpp.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <sstream>

#include "rvelab/cli/command.hpp"
#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"

namespace rvelab::cli {
namespace {

void add(CLI::App& to, const Option& option) {
  if (option.is_flag()) {
    CLI::Option* flag = to.add_flag_callback(
        option.names, [&option] { option.read(option, ""); }, option.help);
    if (!option.excluded.empty()) flag->excludes(option.excluded);
    return;
  }
  const auto read = [&option](const CLI::results_t& words) {
    for (const std::string& word : words) option.read(option, word);
    return true;
  };
  CLI::Option* added = to.add_option(option.names, read, option.help)->required(option.needed);
  added->option_text(option.shown_value());
  if (option.help.empty()) added->group("");
  if (option.list && option.is_positional())
    added->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args();
  if (option.list && !option.is_positional()) added->take_all();
}

void fill(CLI::App& app, const std::vector<Command>& commands, const About& about) {
  app.set_version_flag("--version", about.version);
  app.require_subcommand(1);
  app.footer(about.notes);
  for (const Command& command : commands) {
    CLI::App* added = app.add_subcommand(command.name, command.summary);
    added->footer(command.notes);
    for (const Option& option : command.options) add(*added, option);
  }
}

/// One name of an option ("-o,--output" has two) and the number of words that follow it.
struct KnownOption {
  std::string name;
  int words;
};

std::vector<KnownOption> known_options(const Command* command) {
  std::vector<KnownOption> known{{"--help", 0}, {"-h", 0}};
  if (command == nullptr) known.push_back({"--version", 0});
  if (command == nullptr) return known;
  for (const Option& option : command->options) {
    if (option.is_positional()) continue;
    std::istringstream names(option.names);
    for (std::string name; std::getline(names, name, ',');) known.push_back({name, option.is_flag() ? 0 : 1});
  }
  return known;
}

[[noreturn]] void refuse_option(const Command* command, const std::string& word) {
  std::vector<std::string> names;
  for (const KnownOption& known : known_options(command))
    if (known.name.starts_with("--")) names.push_back(known.name);
  const std::string of = command == nullptr ? "" : command->name + ": ";
  throw InputError(of + "unknown option " + word +
                   (word.starts_with("--") ? "; the nearest is " + keys::nearest(word, names) : "") + "; allowed: " +
                   keys::listed(names) + "; see rvelab " + (command == nullptr ? "" : command->name + " ") + "--help");
}

/// -1.5 and -.5 are values.
bool is_number(const std::string& word) {
  return word.size() > 1 && (std::isdigit(static_cast<unsigned char>(word[1])) != 0 || word[1] == '.');
}

/// The options of one command, or of the program itself, from argv[first] on.
void expect_known_options(const Command* command, int first, int argc, const char* const* argv) {
  const std::vector<KnownOption> known = known_options(command);
  for (int k = first; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == "--") return;
    if (word.size() < 2 || word[0] != '-' || is_number(word)) continue;
    const bool is_long = word[1] == '-';
    const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
    const auto found = std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.name == name; });
    if (found == known.end()) refuse_option(command, name);
    const bool has_value_in_it = is_long ? word.find('=') != std::string::npos : word.size() > 2;
    if (!has_value_in_it) k += found->words;  // the word that follows is its value
  }
}

/// The command that argv[1] names; nullptr: argv[1] is an option of the program itself. Checks all names before CLI11
/// does, whose message would be about what is missing.
const Command* command_named(const std::vector<Command>& commands, int argc, const char* const* argv) {
  const std::string word = argc < 2 ? "" : argv[1];
  const Command* named = nullptr;
  std::vector<std::string> names;
  for (const Command& command : commands) {
    if (command.name == word) named = &command;
    names.push_back(command.name);
  }
  if (named == nullptr && argc >= 2 && !word.starts_with("-"))
    throw InputError("unknown subcommand " + word + "; the nearest is " + keys::nearest(word, names) +
                     "; allowed: " + keys::listed(names) + "; see rvelab --help");
  expect_known_options(named, named == nullptr ? 1 : 2, argc, argv);
  return named;
}

/// The first example of a command's help.
std::string example_of(const Command& command) {
  std::istringstream notes(command.notes);
  const std::string start = "  rvelab " + command.name;
  for (std::string line; std::getline(notes, line);)
    if (line.starts_with(start)) return line.substr(2);
  return "";
}

[[noreturn]] void refuse(const Command* command, const std::string& mistake) {
  if (command == nullptr) throw InputError(mistake + "; see rvelab --help");
  const std::string example = example_of(*command);
  throw InputError(command->name + ": " + mistake + (example.empty() ? "" : "; write for example: " + example) +
                   "; see rvelab " + command->name + " --help");
}

}  // namespace

Asked read_words(const std::vector<Command>& commands, const About& about, int argc, const char* const* argv) {
  const Command* command = command_named(commands, argc, argv);
  CLI::App app(about.summary, "rvelab");
  fill(app, commands, about);
  try {
    app.parse(argc, argv);
    return {command, ""};
  } catch (const CLI::Success& help_or_version) {
    std::ostringstream text;
    app.exit(help_or_version, text, text);
    return {nullptr, text.str()};
  } catch (const CLI::Error& error) {
    refuse(command, error.what());
  } catch (const InputError& error) {
    refuse(command, error.what());
  }
}

std::string help_of(const std::vector<Command>& commands, const About& about) {
  CLI::App app(about.summary, "rvelab");
  fill(app, commands, about);
  return app.help();
}

}  // namespace rvelab::cli
