// One table of a protocol, read key by key: what is read is known; what is left unread at the end is a mistake.
#pragma once

#include <toml++/toml.h>
#include <optional>
#include <string>
#include <vector>

#include "rvelab/io/material_keys.hpp"
#include "rvelab/io/material_toml.hpp"

namespace rvelab::protocol {

/// The line of a node in its file; 0 if it came from the command line.
long line_of(const toml::node& node);

/// A node as TOML writes it.
std::string written(const toml::node& node);

/// Reads one table. Mistakes are collected with their lines; a reading function then returns the default (or, for a
/// key without one, zero) so that reading goes on. Every value read, defaults included, goes into `resolved`.
class TableReader {
 public:
  /// `where` stands before each key in messages, for example "stage.compression". `line` is said for missing keys.
  TableReader(const toml::table& table, std::string where, long line, std::vector<KeyError>& errors);

  /// No default: the key must be there.
  double number(const std::string& key, std::optional<double> initial, const io::Range& range);
  long whole_number(const std::string& key, long initial, const io::Range& range);
  bool truth(const std::string& key, bool initial);
  std::string text(const std::string& key, std::optional<std::string> initial);
  /// One of the words; an empty default is one of them.
  std::string word(const std::string& key, std::optional<std::string> initial, const std::vector<std::string>& words);
  std::vector<double> numbers(const std::string& key, const io::Range& range);

  bool has(const std::string& key) const { return table_.contains(key); }
  /// A mistake at a key that is there: "where.key = value <reason>; allowed: ...; <remedy>".
  void mistake(const std::string& key, const std::string& text);
  /// Declares a key known without reading it.
  void know(const std::string& key) { known_.push_back(key); }
  /// Books every key that is not known.
  void finish();

  const toml::table& resolved() const { return resolved_; }
  void resolve(const std::string& key, const toml::node& value) { resolved_.insert_or_assign(key, value); }

 private:
  const toml::node* find(const std::string& key, bool required, const std::string& allowed);
  double checked(const std::string& key, const toml::node& node, const io::Range& range);

  const toml::table& table_;
  std::string where_;
  long line_;
  std::vector<KeyError>& errors_;
  std::vector<std::string> known_;
  toml::table resolved_;
};

}  // namespace rvelab::protocol
