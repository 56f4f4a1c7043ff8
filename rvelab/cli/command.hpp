// A subcommand as data: its name, what it takes, what it does. command_line.hpp reads the words of a command line into
// it; no subcommand knows the library that does so.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace rvelab::cli {

/// Ends a command with this exit code; it has printed why. A command that Ctrl-C or SIGTERM stopped: 128 plus the
/// number of the signal.
struct Exit : std::exception {
  explicit Exit(int exit_code) : code(exit_code) {}
  int code;
};

/// What one option takes, and where its value goes.
class Option {
 public:
  /// A bool makes a flag. A list of texts takes one word each time the option is given; a positional list takes all
  /// words that are left. Three numbers are one word, "1,2,3".
  using Place = std::variant<bool*, unsigned*, std::size_t*, double*, std::string*, std::optional<std::string>*,
                             std::optional<long>*, std::optional<std::array<double, 3>>*, std::vector<std::string>*>;

  /// `names`: "-o,--output", or the name of a positional. Without `help` the option is not shown.
  Option(std::string names, std::string help, Place place)
      : names(std::move(names)), help(std::move(help)), place(place) {}

  Option& required();
  Option& between(double least, double most);
  Option& one_of(std::vector<std::string> words);
  Option& shows_default();
  Option& not_with(const std::string& other);  ///< flags: one that was added before

  bool is_flag() const { return std::holds_alternative<bool*>(place); }
  bool is_list() const { return std::holds_alternative<std::vector<std::string>*>(place); }
  bool is_positional() const { return names[0] != '-'; }
  /// "INTEGER from 1 to 4096", as the help shows it.
  std::string shown_value() const;
  /// Puts the words into the place. InputError if they are not what it takes.
  void read(const std::vector<std::string>& words) const;

  std::string names, help;
  Place place;
  bool needed = false;
  std::string excluded;  ///< the name that was given to not_with()

 private:
  void read_word(const std::string& word) const;
  std::string allowed() const;  ///< "; allowed: 1 to 4096"; empty without a range

  std::optional<std::pair<double, double>> range_;
  std::vector<std::string> choices_;
  std::string default_;
};

struct Command {
  std::string name, summary;
  /// Below the options in the help: what is not plain from them, then examples.
  std::string notes = {};
  std::deque<Option> options = {};
  /// Does the work and prints. InputError: a mistake of the user's; Exit: the answer is the exit code; anything else
  /// that is thrown: the run failed.
  std::function<void()> run = {};

  /// An option whose value goes into `place`, which lives as long as `run`.
  template <class Value>
  Option& add(const std::string& names, Value& place, const std::string& help) {
    return options.emplace_back(names, help, &place);
  }
  /// The options that several commands have.
  void add_json(bool& place) { add("--json", place, "print one JSON object"); }
  void add_threads(unsigned& place, const std::string& help) { add("--threads", place, help).between(1, 4096); }
  void add_set(std::vector<std::string>& place, const std::string& example) {
    add("--set", place, "KEY=VALUE, for example " + example + "; give it again for more");
  }
};

/// A command with one positional, `word`, and --json; `run` is handed both.
Command command_of_one_word(std::string name, std::string summary, const std::string& word, const std::string& help,
                            bool required, std::string notes, std::function<void(const std::string&, bool json)> run);

}  // namespace rvelab::cli
