// Which rows of a measured curve are its loading, and which are what sensors and machines add to it.
//
// - Of a strain with a deviator beside it, rows before contact: those before the last deviator of zero or less, as long
// as
//   it has not passed 5 % of its largest. Strain counts from there.
// - Rows whose abscissa does not rise above those before it. They are noise of the sensor where they fall by its step
// at
//   most (the smallest change from row to row; where it falls again and again, the median fall) three times over and by
//   5 % of the range, or by 0.5 %: such rows are joined into their mean, since neither order nor values tell them
//   apart. A stress that is held over time keeps its last row, which has the strain of its end.
// - Where the deviator falls by more than 3 % of its largest meanwhile (more than the noise of a load cell), the
// machine
//   stood still or unloaded; farther falls are unloading and reloading. Such rows are left out up to where the abscissa
//   passes its largest again.
// - A row that stands out far beyond all others, before the curve goes on as it was, is a glitch.
// - Rows after the largest abscissa, and those at the end in which the deviator drops to 2 % of its largest while the
//   strain hardly goes on: the machine unloads.
// Rows outside the range that is asked for are not judged.
#pragma once

#include <optional>
#include <vector>

namespace rvelab::fit {

/// Rows of a table, in the units of its columns.
struct Readings {
  std::vector<double> x;         ///< the abscissa; NaN: no number
  std::vector<double> deviator;  ///< beside a strain, or a ratio that stands for it; NaN: no number; empty: none
  bool is_strain = true;         ///< false: a stress
  std::optional<double> from, to;
};

/// A point of the curve: one row, or the mean of those that were joined.
struct LoadingPoint {
  double x = 0;
  std::vector<std::size_t> rows;
};

struct Loading {
  std::vector<LoadingPoint> points;  ///< of rising x
  bool counts_from_contact = false;  ///< from x of `contact`, a row
  std::size_t contact = 0;
  std::vector<std::size_t> joined, before, glitches, unloading, after;  ///< rows
  std::optional<std::size_t> backwards;  ///< a strain that falls while the deviator does not: no unloading, no noise
};

Loading loading_of(const Readings& readings);

}  // namespace rvelab::fit
