// Tables of a scene, read strictly by rvelab's own reader (rvelab/keys/table_reader.hpp): the reader must know every
// key, and every value must be of its kind and in the range of its unit. Here each read gives back its value.
#pragma once

#include <memory>

#include "rvelab/keys/table_reader.hpp"
#include "tools/mpm/error.hpp"

namespace mpm {

/// What numbers of a scene may be, by their units: far beyond what soils, rocks and laboratories have, and so narrow
/// that products of them (masses, moments of inertia, frequencies) are normal numbers.
/// least: of what must be positive; most: of the magnitude of all.
struct Range {
  const char* unit;  ///< "1" of numbers without one
  double least, most;
};

/// Of a key, whose name ends with its unit: young_modulus_Pa.
Range range_of(const std::string& key);

/// One table. A wrong value ends the reading at once. A required key that is not there is reported by finish(), with
/// the keys that are unknown (its value is 0, empty or not a number until then): a misspelt one is thus among them.
class Keys {
 public:
  /// `where`: its dotted name, "" for the whole file. The table must outlive this.
  Keys(const toml::table& table, std::string path, std::string where);

  bool has(const std::string& name) const { return reader_.has(name); }
  /// All numbers lie within the range of their unit (ranges.cpp), those of `least` and `most` too.
  double number(const std::string& name, double initial, double least = -1e300, double most = 1e300);
  double number(const std::string& name);    ///< required
  double positive(const std::string& name);  ///< required, above 0
  long whole_number(const std::string& name, long initial, long least, long most);
  bool boolean(const std::string& name, bool initial);
  std::string text(const std::string& name, const std::string& initial);
  std::string text(const std::string& name);  ///< required
  std::string name();                         ///< the key name, required: letters, digits, _ and -
  /// The first is the default; `required`: there is none, and what else belongs into the table depends on it.
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
  /// Names that are not read here.
  void known(const std::string& name) { reader_.allow(name); }
  void finish();
  /// InputError at the value of a key.
  [[noreturn]] void wrong(const std::string& name, const std::string& message) const;

 private:
  std::string dotted(const std::string& name) const;
  double number(const std::string& name, const Range& range, bool required, double initial);
  /// Ends the reading if the key is there and its value was found wrong.
  void expect_good(const std::string& name) const;
  std::string path_;
  std::shared_ptr<std::vector<rvelab::keys::KeyError>> errors_;  ///< of this table
  rvelab::keys::TableReader reader_;
};

/// "; allowed: clay, sand; the nearest is sand; choose one of these" of a word that is none of them.
template <class Words>
std::string one_of(const Words& words, const std::string& word) {
  const std::vector<std::string> all(words.begin(), words.end());
  return "; allowed: " + (all.empty() ? "none, since there is none" : rvelab::keys::listed(all)) + "; " +
         rvelab::keys::choose_one(word, all);
}

}  // namespace mpm
