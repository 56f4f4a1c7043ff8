// A specimen under check: common parts of its checks, and the names of fields in their messages.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

/// With sufficient digits to distinguish it from the end of a range.
inline std::string digits_of(double value) {
  char digits[32];
  return {digits, std::to_chars(std::begin(digits), std::end(digits), value).ptr};
}

struct CheckedSpecimen {
  const Specimen& s;
  const std::string& where;  ///< text before the name of a field, such as a path

  [[noreturn]] void refuse(const std::string& what) const { advise(what + "; correct it, or make the specimen again"); }
  /// The same for a message that contains its remedy.
  [[noreturn]] void advise(const std::string& what) const { throw InputError(where + what); }

  static std::string at(const std::string& field, std::size_t k) { return field + ("[" + std::to_string(k) + "]"); }
  std::string of_grain(const char* field, std::size_t k) const {
    return at(field, k) + " of grain " + std::to_string(s.grains.id[k]);
  }

  /// A pair in words: "contacts[3], grains 4 and 7 (i = 3, j = 6, image 0, 1, 0)".
  template <class Item>
  std::string pair(const std::string& group, const Item& c, std::size_t k) const {
    const auto id = [&](std::int32_t g) { return std::to_string(s.grains.id[std::size_t(g)]); };
    return at(group, k) + ", grains " + id(c.i) + " and " + id(c.j) + " (i = " + std::to_string(c.i) +
           ", j = " + std::to_string(c.j) + ", image " + std::to_string(c.image[0]) + ", " +
           std::to_string(c.image[1]) + ", " + std::to_string(c.image[2]) + ")";
  }

  /// Pairs of existing grains, each once and in order. `each`: the name of one pair.
  template <class Item>
  void check_pairs(const std::string& group, const std::string& each, const std::vector<Item>& items) const {
    const std::size_t n = s.grains.size();
    for (std::size_t k = 0; k < items.size(); ++k) {
      const Item& c = items[k];
      if (c.j < c.i || std::size_t(c.j) >= n)
        refuse(at(group + "/i", k) + " = " + std::to_string(c.i) + ", " + at(group + "/j", k) + " = " +
               std::to_string(c.j) + "; allowed: 0 <= i <= j < " + std::to_string(n));
      if (c.i == c.j && c.image == Image{})
        refuse(pair(group, c, k) + " is a grain that touches itself; allowed: an image of it, in " + group + "/image");
      if (k > 0 && pair_of(c) == pair_of(items[k - 1]))
        refuse(pair(group, c, k) + " stands twice; allowed: each " + each + " once");
      if (k > 0 && pair_of(c) < pair_of(items[k - 1]))
        refuse(pair(group, c, k) + " is out of order; allowed: " + group + " sorted by i, then j, then image");
      for (std::size_t d = 0; d < c.image.size(); ++d)  // reduction of the cell increases it
        if (std::abs(double(c.image[d])) > 1e9)
          refuse(group + "/image[" + std::to_string(k) + ", " + std::to_string(d) +
                 "] = " + std::to_string(c.image[d]) + " is out of range; allowed: -1e9 to 1e9");
    }
  }
};

}  // namespace rvelab
