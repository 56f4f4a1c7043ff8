// Numbers as people and machines write them: "1.5", "1,5", "1,234.5", "1.234,5", "1 234,5", "1'234.5", "1,5E-03".
#pragma once

#include <optional>
#include <string_view>

namespace rvelab::fit {

/// A cell that reads as a number.
struct Numeral {
  double value = 0;      ///< with `mark` as the decimal mark
  char mark = 0;         ///< ',' or '.', the decimal mark; 0: it has none
  bool certain = false;  ///< false: the mark may part groups of digits as well, "1,234" (or there is none)
  char groups = 0;       ///< mark that groups its digits, for certain; 0: none
  double grouped = 0;    ///< where a mark is not certain: the value if it parts groups
};

/// None: the cell is no finite number.
std::optional<Numeral> numeral(std::string_view cell);

}  // namespace rvelab::fit
