// One table of a TOML file, read key by key with a table of keys (table_key.hpp), which knows kind, default and range
// of each.
#pragma once

#include <toml++/toml.h>
#include <optional>
#include <string>
#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/keys/table_key.hpp"

namespace rvelab::keys {

/// The line of a node in its file; 0 if it came from the command line.
long line_of(const toml::node& node);

/// A node as TOML writes it.
std::string written(const toml::node& node);

/// What is wrong with a value of a key, with what is allowed and the remedy: "is out of range; allowed: > 0 Pa; give a
/// value in this range". "" if nothing is. By the type of the key; `range` is of numbers, `choices` of a choice.
std::string wrong_with(const toml::node& value, const Key& key, const Interval& range,
                       const std::vector<std::string>& choices);

/// Adds a mistake for what is none of the tables `known` at the top level of a file.
void expect_top_tables(const toml::table& file, std::vector<KeyError>& errors, const std::vector<std::string>& known);

/// A table of the file; an empty one where there is none, a mistake where it is something else.
const toml::table& table_of(const toml::table& file, const std::string& name, std::vector<KeyError>& errors);

/// Reads one table. Mistakes are collected with their lines; a reading function then returns the default (or, for a
/// key without one, zero) so that reading goes on. Every value read, defaults included, goes into `resolved`.
class TableReader {
 public:
  /// `all`: the entries of every table, which outlive the reader. `key_table`: the one of them that is read, which
  /// `where` is called in messages: "stage.isotropic" and, with a name of its own, "stage.consolidation". `line` is
  /// said for missing keys.
  TableReader(const toml::table& table, const std::vector<TableKey>& all, const std::string& key_table,
              std::string where, long line, std::vector<KeyError>& errors);

  /// Keys of a further table of the entries may stand here too.
  void also(const std::string& key_table);

  // Each key by its name in the key table. A key without a default there must be in the file, unless `instead` is its
  // computed default or the optional form is asked for.
  double number(const std::string& name, std::optional<double> instead = std::nullopt);
  std::optional<double> optional_number(const std::string& name);
  long whole_number(const std::string& name);
  std::optional<long> optional_whole_number(const std::string& name);
  bool boolean(const std::string& name, std::optional<bool> instead = std::nullopt);
  std::string text(const std::string& name, std::optional<std::string> instead = std::nullopt);
  /// One of the choices of the key; "" stands for a computed default that is not known yet.
  std::string choice(const std::string& name, std::optional<std::string> instead = std::nullopt);
  std::vector<double> numbers(const std::string& name);
  /// Those of the choices of the key that stand there; none if the key does not.
  std::vector<std::string> choices(const std::string& name);
  /// Components of a tensor by their names, zero where none is given; a symmetric one has both halves of a shear.
  Matrix3 components(const std::string& name, bool symmetric);
  /// Lists of 4 or 9 numbers, row by row.
  std::vector<Matrix3> matrices(const std::string& name);
  /// The tables of [[...]] under this key; what is read of them is put into the resolved table by the caller.
  std::vector<const toml::table*> tables(const std::string& name);
  void resolve(const std::string& name, toml::array list) { resolved_.insert_or_assign(name, std::move(list)); }

  bool has(const std::string& name) const { return table_.contains(name); }
  /// The key is there, but with another unit of the same quantity.
  bool has_in_another_unit(const std::string& name) const;
  /// Adds a mistake at a key: "where.name = value <text>", with its line; the table's if it is not there.
  void mistake(const std::string& name, const std::string& text);
  /// Says that a key has no meaning here, so that it is not asked for.
  void leave(const std::string& name) { entry(name); }
  /// Adds a mistake for every key that is not known. std::logic_error if a known one was not asked for.
  void finish();

  const toml::table& resolved() const { return resolved_; }

 private:
  const TableKey& entry(const std::string& name);
  const toml::node* find(const TableKey& key, bool required);
  std::optional<double> checked(const TableKey& key, const toml::node& node);
  /// The node of a key that must be in the file unless it has a default, if its value is good.
  const toml::node* good(const TableKey& key, bool required);

  const toml::table& table_;
  const std::vector<TableKey>& all_;
  std::vector<std::string> key_tables_;
  std::string where_;
  long line_;
  std::vector<KeyError>& errors_;
  std::vector<Key> known_;
  std::vector<std::string> asked_;
  toml::table resolved_;
};

}  // namespace rvelab::keys
