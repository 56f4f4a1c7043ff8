// TOML read strictly: the reader must know every key of a table, and every value must be of its kind and in its range.
// An error names file, line, key, what is allowed and what to do.
#pragma once

#include <toml++/toml.h>

#include <set>
#include <string>
#include <vector>

#include "tools/mpm/error.hpp"
#include "tools/mpm/keys/ranges.hpp"

namespace mpm {

/// One table. Reading a key makes it known; finish() then throws for unknown keys, and after them for a missing one
/// that is required (its value is 0, empty or not a number until then): a misspelt key is thus reported as such.
class Keys {
 public:
  /// `where`: its dotted name, "" for the whole file. The table must outlive this.
  Keys(const toml::table& table, std::string path, std::string where);

  bool has(const std::string& name) const { return table_->contains(name); }
  /// All numbers lie within the range of their unit (ranges.hpp), those of `least` and `most` too.
  double number(const std::string& name, double initial, double least = -1e300, double most = 1e300);
  double number(const std::string& name);    ///< required
  double positive(const std::string& name);  ///< required, above 0
  long whole_number(const std::string& name, long initial, long least, long most);
  bool boolean(const std::string& name, bool initial);
  std::string text(const std::string& name, const std::string& initial);
  std::string text(const std::string& name);  ///< required
  std::string name();                         ///< the key name, required: letters, digits, _ and -
  /// The first is the default; `required`: there is none.
  std::string choice(const std::string& name, const std::vector<std::string>& allowed, bool required = false);
  /// One number for each axis; `initial` empty: required. `one_for_all`: a single number will do.
  std::vector<double> vector(const std::string& name, std::size_t axes, const std::vector<double>& initial,
                             bool one_for_all = false);
  std::vector<double> numbers(const std::string& name, std::size_t size);  ///< required
  /// Rows of `size` numbers each; none if the key is not there. units: as keys end with them, of the columns ("_s",
  /// "_m_s"), the last for all that follow; none: that of the key.
  std::vector<std::vector<double>> rows(const std::string& name, std::size_t size,
                                        const std::vector<std::string>& units = {});
  /// InputError unless a number that was read is positive, and as large as its unit has it.
  void expect_positive(const std::string& name, double value) const;
  /// Numbers in the first row of such a list; 0 if there is none.
  std::size_t row_length(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name);  ///< required, not empty
  /// Tables under a name: [name] (empty if it is not there), or each [[name]].
  Keys table(const std::string& name);
  std::vector<Keys> tables(const std::string& name);
  /// Names of the tables under a table, which are not read here.
  void known(const std::string& name) { known_.insert(name); }
  void finish() const;
  /// InputError at the value of a key.
  [[noreturn]] void wrong(const std::string& name, const std::string& message) const;

 private:
  const toml::node* get(const std::string& name);
  std::string dotted(const std::string& name) const { return where_.empty() ? name : where_ + "." + name; }
  void missing(const std::string& name, const std::string& remedy);
  std::string unknown(const std::string& name, const toml::node& node, const std::string& nearest) const;
  double within(const std::string& name, const toml::node& value, const Range& range) const;
  std::vector<double> list(const std::string& name, std::size_t size, const std::string& what) const;
  const toml::table* table_;  ///< copies of a table would not know their lines
  std::string path_, where_;
  std::string missing_;  ///< the message on the first required key that is not there
  std::set<std::string> known_;
};

/// The word with the fewest edits; "" if there are none.
std::string nearest_word(const std::string& word, const std::set<std::string>& words);

/// A whole file. InputError if there is none, with line and column if it is no TOML.
toml::table parse_file(const std::string& path);
/// Overrides `base` by `over`: tables key by key, arrays of tables element by element, everything else as a whole.
void override_table(toml::table& base, const toml::table& over);
/// One assignment of the command line, a.b.c=value. In an array of tables an element goes by its `name` or its number,
/// from 0.
void assign(toml::table& scene, const std::string& assignment);

}  // namespace mpm
