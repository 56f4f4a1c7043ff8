// A subcommand as data: its name, what it takes, what it does. command_line.cpp reads the words of a command line into
// it; no subcommand knows the library that does so.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rvelab::cli {

/// Ends a command with this exit code; it has printed why. A command that Ctrl-C or SIGTERM stopped: 128 plus the
/// number of the signal.
struct Exit : std::exception {
  explicit Exit(int exit_code) : code(exit_code) {}
  int code;
};

using ThreeNumbers = std::array<double, 3>;

/// One option, or a positional argument.
struct Option {
  std::string names;  ///< "-o,--output", or the name of a positional
  std::string help;   ///< empty: the option is not shown
  const char* type;   ///< "INTEGER", as the help shows it; empty: a flag
  bool list;          ///< takes one word each time it is given; a positional takes all words that are left
  bool needed = false;
  std::string excluded = {};  ///< a flag that was added before and does not go with this one
  std::optional<std::pair<double, double>> range = {};
  std::vector<std::string> words = {};  ///< those that are allowed; none: any
  std::string initial = {};             ///< default that the help shows
  std::function<void(const Option&, const std::string& word)> read =
      {};  ///< InputError if the word is not what it takes

  Option& required() { return needed = true, *this; }
  Option& between(double least, double most) { return range = {least, most}, *this; }
  Option& one_of(std::vector<std::string> allowed) { return words = std::move(allowed), *this; }
  Option& shows_default(const std::string& value) { return initial = value, *this; }
  Option& not_with(const std::string& other) { return excluded = other, *this; }
  bool is_flag() const { return *type == 0; }
  bool is_positional() const { return names[0] != '-'; }
  /// "INTEGER from 1 to 4096", as the help shows it.
  std::string shown_value() const;
  [[noreturn]] void refuse(const std::string& word, const std::string& why) const;
};

/// A word as a value. A list of texts takes further words, three numbers are one word, "1,2,3".
void read_word(const Option& option, const std::string& word, bool& value);
void read_word(const Option& option, const std::string& word, std::string& value);
void read_word(const Option& option, const std::string& word, double& value);
void read_word(const Option& option, const std::string& word, long& value);
void read_word(const Option& option, const std::string& word, std::size_t& value);
void read_word(const Option& option, const std::string& word, unsigned& value);
void read_word(const Option& option, const std::string& word, ThreeNumbers& value);
template <class Value>
void read_word(const Option& option, const std::string& word, std::optional<Value>& value) {
  read_word(option, word, value.emplace());
}
inline void read_word(const Option& option, const std::string& word, std::vector<std::string>& values) {
  read_word(option, word, values.emplace_back());
}

/// How the help calls values of a type.
constexpr const char* shown(const bool&) { return ""; }
inline const char* shown(const std::string&) { return "TEXT"; }
constexpr const char* shown(const double&) { return "NUMBER"; }
constexpr const char* shown(const ThreeNumbers&) { return "NUMBER,NUMBER,NUMBER"; }
template <class Integer>
requires std::is_integral_v<Integer>
constexpr const char* shown(const Integer&) { return "INTEGER"; }
template <class Value>
const char* shown(const std::optional<Value>&) {
  return shown(Value{});
}
inline const char* shown(const std::vector<std::string>&) { return "TEXT"; }

struct Command {
  std::string name, summary;
  std::deque<Option> options = {};
  /// Below the options in the help: what is not plain from them, then examples.
  std::string notes = {};
  /// Does the work and prints. InputError: a mistake of the user's; Exit: the answer is the exit code; anything else
  /// that is thrown: the run failed.
  std::function<void()> run = {};

  /// A command whose options go into an `Arguments`, which `work` is handed.
  template <class Arguments>
  Arguments& runs(void (*work)(const Arguments&)) {
    const auto arguments = std::make_shared<Arguments>();
    run = [arguments, work] { work(*arguments); };
    return *arguments;
  }
  /// An option whose value goes into `place`.
  template <class Value>
  Option& add(const std::string& names, Value& place, const std::string& help) {
    constexpr bool list = std::is_same_v<Value, std::vector<std::string>>;
    options.push_back({names, help, shown(place), list});
    options.back().read = [&place](const Option& option, const std::string& word) { read_word(option, word, place); };
    return options.back();
  }
  /// The options that several commands have.
  void add_json(bool& place) { add("--json", place, "print one JSON object"); }
  void add_force(bool& place, const std::string& what = "an existing file") {
    add("--force", place, "overwrite " + what);
  }
  void add_threads(unsigned& place, const std::string& help) { add("--threads", place, help).between(1, 4096); }
  void add_set(std::vector<std::string>& place, const std::string& example) {
    add("--set", place, "KEY=VALUE, for example " + example + "; give it again for more");
  }
};

/// A command with one positional, `word`, and --json; `run` is handed both.
Command command_of_one_word(std::string name, std::string summary, const std::string& word, const std::string& help,
                            bool required, std::string notes, std::function<void(const std::string&, bool json)> run);

// The subcommands of the program, one file each; main.cpp puts them together.
Command pack_command(), import_command(), inspect_command(), measure_command(), probe_command(), run_command(),
    recover_command(), seal_command(), calibrate_command(), critical_command(), fit_command(), study_command(),
    report_command(), compare_command(), export_command(), protocols_command(), keys_command(), bench_command();

/// What the words of a command line ask for: a command, its options filled in, or a text (help, version).
struct Asked {
  const Command* command = nullptr;
  std::string text;
};

/// What the help of the program itself holds, and its version.
struct About {
  std::string summary, notes, version;
};

/// InputError with the nearest name if a subcommand or an option is not known, with an example if one is missing.
Asked read_words(const std::vector<Command>& commands, const About& about, int argc, const char* const* argv);

/// The help of the program itself.
std::string help_of(const std::vector<Command>& commands, const About& about);

}  // namespace rvelab::cli
