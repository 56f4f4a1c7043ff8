// One table of a TOML file, read key by key. Each call says all there is to say of a key: its name, unit, range and
// meaning; its default is the value that the field has before. So what is read, what is refused and what `rvelab keys`
// prints cannot differ: the documentation is what the same readers ask of empty tables.
#pragma once

#include <toml++/toml.h>

#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/keys/key.hpp"

namespace rvelab::keys {

using Choices = std::vector<std::string>;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr Interval every{-infinity, infinity, true, true};
inline constexpr Interval positive{0, infinity, true, true};
inline constexpr Interval not_negative{0, infinity, false, true};
inline constexpr Interval ratio{0, 1, true, true};
inline constexpr Interval below_one{0, 1, false, true};
inline constexpr Interval steps{1, 1e12};
/// Of pressures that grains are brought to, Pa: beyond any solid's stiffness, and squares of forces would overflow.
/// Below 1 kPa, 6 cm of soil, kPa was likely left out.
inline constexpr Range pressures{{0, 1e15, true, false}, {{1e3, 1e9}}};
/// Of pressures that grains already bear when a stage begins.
inline constexpr Range held_pressures{positive, pressures.usual};
/// The same with 0, which bonded grains can bear.
inline constexpr Range pressures_from_zero{{0, 1e15}, pressures.usual};
inline constexpr Range held_pressures_from_zero{not_negative, pressures.usual};
/// Of sizes of grains, m: colloids to boulders.
inline constexpr Range radii{positive, {{1e-8, 1}}};
/// Of coefficients that an angle in degrees may have been written for; from 100 on no slip is meant.
inline constexpr Usual friction_values{{0, 2}, 100};

inline constexpr const char* symmetric_components = "xx, yy, zz, yz, xz, xy = numbers";

/// Values as TOML writes them.
std::string as_toml(double value);
std::string as_toml(const std::string& value);

/// "a, b, c".
std::string listed(const Choices& words);

/// The line of a node in its file; 0 if it came from the command line.
long line_of(const toml::node& node);

/// A node as TOML writes it.
std::string written(const toml::node& node);

/// A table as the text of a file.
std::string written_file(const toml::table& file);

/// What is wrong with a value of a key, with what is allowed and the remedy: "is out of range; allowed: > 0 Pa; give a
/// value in this range". "" if nothing is. By the type of the key.
std::string wrong_with(const toml::node& value, const Key& key);

/// Adds a mistake for what is none of the tables `known` at the top level of a file.
void expect_top_tables(const toml::table& file, std::vector<KeyError>& errors, const std::vector<std::string>& known);

/// A table of the file; an empty one where there is none, a mistake where it is something else.
const toml::table& table_of(const toml::table& file, const std::string& name, std::vector<KeyError>& errors);

/// Reads one table. Mistakes are collected with their lines; the field then stays as it was, and reading goes on. Every
/// value read, defaults included, goes into `resolved`. A key that is given nothing in its place has no default.
class TableReader {
 public:
  /// `key_table`: the table as the documentation calls it, "stage.isotropic"; `where`: as messages do, with a name of
  /// its own "stage.consolidation", "" for the whole file. `line` is said for missing keys.
  TableReader(const toml::table& table, std::string key_table, std::string where, long line,
              std::vector<KeyError>& errors)
      : table_(table), key_table_(std::move(key_table)), where_(std::move(where)), line_(line), errors_(errors) {}

  void number(const char* name, double& value, const char* unit, const Range& range, const char* meaning);
  /// Must be there; false: it is not, or wrong. `allowed`: the range in words, where it says more.
  bool required_number(const char* name, double& value, const char* unit, const Range& range, const char* meaning,
                       const char* allowed = "");
  /// `initial`: in words, what holds where the key is not there.
  std::optional<double> optional_number(const char* name, const char* unit, const Range& range, const char* meaning,
                                        const std::string& initial = "", const char* allowed = "");
  template <class Integer>
  void whole_number(const char* name, Integer& value, const Interval& range, const char* meaning) {
    value = Integer(whole_given({name, "", "", std::to_string(value), "", meaning, range}).value_or(long(value)));
    resolved_.insert_or_assign(name, std::int64_t(value));
  }
  std::optional<long> optional_whole_number(const char* name, const Interval& range, const char* meaning,
                                            const char* initial, const char* allowed);
  void boolean(const char* name, bool& value, const char* meaning, const char* initial = nullptr);
  void text(const char* name, std::string& value, const char* meaning, const char* initial = nullptr);
  std::string required_text(const char* name, const char* meaning);
  /// One of some words. The values of an enumeration or bool are the numbers of the words.
  template <class Value>
  void choice(const char* name, Value& value, const Choices& words, const std::string& meaning) {
    static_assert(std::is_enum_v<Value> || std::is_same_v<Value, bool>);
    value = static_cast<Value>(number_of_choice(name, std::size_t(value), words, meaning));
  }
  /// `instead`: the word that holds where the key is not there; "": it is not known yet. `initial`: the same in words.
  std::string choice(const char* name, const std::string& instead, const Choices& words, const char* meaning,
                     const char* initial);
  /// "" if it is not there, or wrong.
  std::string required_choice(const char* name, const Choices& words, const char* meaning);
  /// Lists are empty where the key is not there. `allowed`: "each > 0" unless said.
  std::vector<double> numbers(const char* name, const char* unit, const Range& each, const char* meaning,
                              const char* allowed = nullptr, bool required = false);
  /// Some of the words.
  std::vector<std::string> choices(const char* name, const Choices& words, const char* meaning,
                                   const std::string& initial);
  std::vector<std::string> texts(const char* name, const char* meaning);
  /// Components of a tensor by their names, zero where none is given; a symmetric one has both halves of a shear.
  Matrix3 components(const char* name, const char* unit, const char* meaning, bool symmetric);
  /// Lists of 4 or 9 numbers, row by row.
  std::vector<Matrix3> matrices(const char* name, const char* meaning);
  /// The tables of [[stage.NAME]], each by read(reader); a reader without any documents the keys in `key_table`.
  template <class Read>
  auto tables(const char* name, const char* key_table, bool required, const std::string& allowed,
              const std::string& meaning, Read read) {
    std::vector<std::invoke_result_t<Read, TableReader&>> items;
    toml::array resolved;
    const auto take = [&](const toml::table& table, long line, std::vector<KeyError>& errors) {
      const std::string number = table["name"].value_or(std::to_string(items.size()));
      TableReader reader(table, key_table, where_ + "." + name + "." + number, line, errors);
      items.push_back(read(reader));
      reader.finish();
      resolved.push_back(reader.resolved());
      inner_keys_ = reader.keys();
    };
    for (const toml::table* table : tables_of(name, required, allowed, meaning)) take(*table, line_of(*table), errors_);
    if (!items.empty()) {
      resolved_.insert_or_assign(name, std::move(resolved));
      return items;
    }
    std::vector<KeyError> ignored;
    take({}, 0, ignored);
    items.clear();
    return items;
  }

  bool has(const std::string& name) const { return table_.contains(name); }
  /// A key that another reader reads.
  void allow(const std::string& name) { known_.push_back({key_table_, name, "-", "", "", "", ""}); }
  /// A key that was asked for is there, but with another unit of the same quantity.
  bool has_in_another_unit(const std::string& name) const;
  /// Adds a mistake at a key: "where.name = value <text>", with its line; the table's if it is not there.
  void mistake(const std::string& name, const std::string& text);
  /// A key that was asked for has no meaning here: a mistake if it is there.
  void refuse(const std::string& name, const std::string& text);
  /// A mistake if a key that was asked for is not there, in another unit either.
  void expect(const std::string& name, const std::string& text = "");
  /// A mistake that is not of one key: at the line of the table, or of the first table of a list in it.
  void mistake(const std::string& text) { errors_.push_back({line_, text}); }
  void mistake_in(const std::string& list, const std::string& text);
  void resolve(const std::string& name, double value) { resolved_.insert_or_assign(name, value); }
  /// Adds a mistake for every key that was not asked for.
  void finish();

  const std::string& where() const { return where_; }
  const toml::table& table() const { return table_; }
  /// Adds a doubt of a key that is there: "where.name = value <text>", with its line; nothing where the text is empty.
  void doubt(const std::string& name, const std::string& text);
  std::size_t mistakes() const { return mistakes_in(errors_); }
  const toml::table& resolved() const { return resolved_; }
  /// Every key that was asked for, in order, and those of the tables in lists.
  std::vector<Key> keys() const;

 private:
  /// The key as it was asked for.
  struct Asked {
    const char *name, *unit, *type;
    std::string initial, range;
    std::string meaning;
    Range interval{};
    Choices choices{};
    bool required = false;
  };
  std::string dotted(const std::string& name) const { return where_.empty() ? name : where_ + "." + name; }
  Key asked(Asked key);
  const toml::node* find(const Key& key);
  /// The node of a key if it is there and its value is good.
  const toml::node* good(const Key& key);
  // A value of a kind, if it is there and good.
  std::optional<double> number_given(Asked key);
  std::optional<long> whole_given(Asked key);
  std::optional<std::string> word_given(Asked key);
  std::size_t number_of_choice(const char* name, std::size_t value, const Choices& words, const std::string& meaning);
  std::vector<const toml::table*> tables_of(const char* name, bool required, const std::string& allowed,
                                            const std::string& meaning);
  std::optional<double> checked(const Key& key, const toml::node& node);

  const toml::table& table_;
  std::string key_table_, where_;
  long line_;
  std::vector<KeyError>& errors_;
  std::vector<Key> known_, inner_keys_;
  toml::table resolved_;
};

}  // namespace rvelab::keys
