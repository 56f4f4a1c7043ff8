#include "rvelab/cli/command.hpp"

#include <algorithm>
#include <charconv>
#include <type_traits>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"

namespace rvelab::cli {
namespace {

/// Whether the whole word is the number.
template <class Number>
bool reads(const std::string& word, Number& number) {
  const char* last = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), last, number);
  return error == std::errc() && end == last;
}

template <class Number>
void read_number(const Option& option, const std::string& word, Number& value) {
  const std::string allowed =
      option.range ? "; allowed: " + in_words(option.range->first) + " to " + in_words(option.range->second) : "";
  if (!reads(word, value))
    option.refuse(word, (std::is_integral_v<Number> ? "is not a whole number" : "is not a number") + allowed);
  if (option.range && !(double(value) >= option.range->first && double(value) <= option.range->second))
    option.refuse(word, "is out of range" + allowed);
}

}  // namespace

std::string Option::shown_value() const {
  std::string text = type;
  for (std::size_t k = 0; k < words.size(); ++k) text = (k == 0 ? "" : text + " | ") + words[k];
  if (range) text += " from " + in_words(range->first) + " to " + in_words(range->second);
  if (list && is_positional()) text += " ...";
  if (!initial.empty()) text += ", default " + initial;
  if (needed) text += ", required";
  return text;
}

void Option::refuse(const std::string& word, const std::string& why) const {
  const std::size_t at = names.find("--");
  throw InputError(names.substr(at == std::string::npos ? 0 : at) + ": " + word + " " + why);
}

void read_word(const Option&, const std::string&, bool& value) { value = true; }
void read_word(const Option& option, const std::string& word, std::string& value) {
  const auto& words = option.words;
  if (!words.empty() && std::find(words.begin(), words.end(), word) == words.end())
    option.refuse(word, "not in {" + keys::listed(words) + "}");
  value = word;
}
void read_word(const Option& option, const std::string& word, double& value) { read_number(option, word, value); }
void read_word(const Option& option, const std::string& word, long& value) { read_number(option, word, value); }
void read_word(const Option& option, const std::string& word, std::size_t& value) { read_number(option, word, value); }
void read_word(const Option& option, const std::string& word, unsigned& value) { read_number(option, word, value); }

void read_word(const Option& option, const std::string& word, ThreeNumbers& value) {
  const std::size_t first = word.find(','), second = word.find(',', first + 1);
  const bool good = second != std::string::npos && reads(word.substr(0, first), value[0]) &&
                    reads(word.substr(first + 1, second - first - 1), value[1]) &&
                    reads(word.substr(second + 1), value[2]);
  if (!good) option.refuse(word, "is not three numbers with commas between; write for example 1,1,0.5");
}

Command command_of_one_word(std::string name, std::string summary, const std::string& word, const std::string& help,
                            bool required, std::string notes, std::function<void(const std::string&, bool json)> run) {
  struct Arguments {
    std::string word;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  Command command{std::move(name), std::move(summary)};
  command.notes = std::move(notes);
  command.add(word, arguments->word, help).needed = required;
  command.add_json(arguments->json);
  command.run = [arguments, run = std::move(run)] { run(arguments->word, arguments->json); };
  return command;
}

}  // namespace rvelab::cli
