#include "rvelab/cli/command.hpp"

#include <algorithm>
#include <charconv>
#include <memory>
#include <type_traits>

#include "rvelab/error.hpp"

namespace rvelab::cli {
namespace {

using ThreeNumbers = std::array<double, 3>;

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// The type itself, or that of an optional or a list.
template <class Value>
struct ElementOf {
  using Type = Value;
};
template <class Value>
struct ElementOf<std::optional<Value>> {
  using Type = Value;
};
template <class Value>
struct ElementOf<std::vector<Value>> {
  using Type = Value;
};

/// Whether the whole word is the number.
template <class Number>
bool reads(const std::string& word, Number& number) {
  const char* last = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), last, number);
  return error == std::errc() && end == last;
}

/// "1,2,3".
bool reads(const std::string& list, ThreeNumbers& numbers) {
  const std::size_t first = list.find(','), second = list.find(',', first + 1);
  return second != std::string::npos && reads(list.substr(0, first), numbers[0]) &&
         reads(list.substr(first + 1, second - first - 1), numbers[1]) && reads(list.substr(second + 1), numbers[2]);
}

template <class Element>
constexpr const char* shown_type() {
  return std::is_same_v<Element, bool>           ? ""
         : std::is_same_v<Element, std::string>  ? "TEXT"
         : std::is_same_v<Element, ThreeNumbers> ? "NUMBER,NUMBER,NUMBER"
         : std::is_integral_v<Element>           ? "INTEGER"
                                                 : "NUMBER";
}

}  // namespace

Option& Option::required() {
  needed = true;
  return *this;
}

Option& Option::between(double least, double most) {
  range_ = {least, most};
  return *this;
}

Option& Option::one_of(std::vector<std::string> words) {
  choices_ = std::move(words);
  return *this;
}

Option& Option::shows_default() {
  if (const auto* text = std::get_if<std::string*>(&place)) default_ = **text;
  if (const auto* number = std::get_if<double*>(&place)) default_ = in_words(**number);
  return *this;
}

Option& Option::not_with(const std::string& other) {
  excluded = other;
  return *this;
}

std::string Option::shown_value() const {
  std::string text = std::visit(
      []<class Value>(Value*) -> std::string { return shown_type<typename ElementOf<Value>::Type>(); }, place);
  if (!choices_.empty()) text = joined(choices_, " | ");
  if (range_) text += " from " + in_words(range_->first) + " to " + in_words(range_->second);
  if (is_list() && is_positional()) text += " ...";
  if (!default_.empty()) text += ", default " + default_;
  if (needed) text += ", required";
  return text;
}

std::string Option::allowed() const {
  return range_ ? "; allowed: " + in_words(range_->first) + " to " + in_words(range_->second) : "";
}

void Option::read_word(const std::string& word) const {
  const auto refuse = [&](const std::string& why) {
    const std::size_t at = names.find("--");
    throw InputError(names.substr(at == std::string::npos ? 0 : at) + ": " + word + " " + why);
  };
  if (!choices_.empty() && std::find(choices_.begin(), choices_.end(), word) == choices_.end())
    refuse("not in {" + joined(choices_, ", ") + "}");
  const auto read_into = [&]<class Value>(Value* value) {
    typename ElementOf<Value>::Type element{};
    using Element = decltype(element);
    if constexpr (std::is_same_v<Element, bool>) {
      element = true;
    } else if constexpr (std::is_same_v<Element, std::string>) {
      element = word;
    } else if constexpr (std::is_same_v<Element, ThreeNumbers>) {
      if (!reads(word, element)) refuse("is not three numbers with commas between; write for example 1,1,0.5");
    } else {
      if (!reads(word, element))
        refuse((std::is_integral_v<Element> ? "is not a whole number" : "is not a number") + allowed());
      if (range_ && !(double(element) >= range_->first && double(element) <= range_->second))
        refuse("is out of range" + allowed());
    }
    if constexpr (std::is_same_v<Value, std::vector<std::string>>)
      value->push_back(element);
    else
      *value = element;
  };
  std::visit(read_into, place);
}

void Option::read(const std::vector<std::string>& words) const {
  for (const std::string& word : words) read_word(word);
}

Command command_of_one_word(std::string name, std::string summary, const std::string& word, const std::string& help,
                            bool required, std::string notes, std::function<void(const std::string&, bool json)> run) {
  struct Arguments {
    std::string word;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  Command command{std::move(name), std::move(summary), std::move(notes)};
  command.add(word, arguments->word, help).needed = required;
  command.add_json(arguments->json);
  command.run = [arguments, run = std::move(run)] { run(arguments->word, arguments->json); };
  return command;
}

}  // namespace rvelab::cli
