// A measured curve as targets: read from CSV, brought to a few abscissae, and the same curve of a test.
//
// The header names the columns, with units (column_kinds.hpp): the abscissa first, then one or more curves over it,
// each with its standard error if it has one (NAME_error). Compression is positive.
//   abscissa   axial_strain, shear_strain; p, axial_stress (interpolated in their logarithm)
//   curves     q_over_p, deviator (sigma_1 - sigma_3), p, volumetric_strain, void_ratio; over a stress axial_strain,
//              which counts from its first point
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "rvelab/fit/search.hpp"
#include "rvelab/records/record.hpp"

namespace rvelab::fit {

/// What is read off a curve over a strain; NaN: it does not give it. SI units of the curve.
struct Features {
  double largest = nan(), at_largest = nan();  ///< highest value, and the abscissa where it is reached first
  double early = nan();                        ///< at `early_strain`
  double last = nan();                         ///< at the last abscissa

  static constexpr double early_strain = 1e-3;
  static constexpr double nan() { return std::numeric_limits<double>::quiet_NaN(); }
};

struct Curve {
  std::string name;                                ///< of the quantity: "deviator"
  std::string abscissa;                            ///< "strain", "p" or "axial_stress"
  std::vector<double> x, y, error;                 ///< SI; at most `most_points` rows of the measured range
  Features features{};                             ///< of all its rows
  std::string file{};                              ///< path, for messages
  std::vector<double> all_x{}, all_y{};            ///< all rows
  std::vector<double> unloaded_x{}, unloaded_y{};  ///< over a stress: the rows behind, as long as it falls
};

inline constexpr std::size_t most_points = 12;

/// Which columns and rows of a file are read.
struct Selection {
  /// "KIND", or "KIND=NAME" for a column of another name ("deviator_kPa=q"), the abscissa first; further columns are
  /// left out. Empty: all columns, each of which must be known.
  std::vector<std::string> columns;
  std::optional<double> from, to;  ///< of the abscissa, in the unit of its column; the ends of the file
};

/// Takes a sentence about what was joined or left out.
using Tell = std::function<void(const std::string&)>;

/// The curves of a table as laboratories write it (measured_table.hpp), of its loading (loading.hpp). A curve of more
/// than `most_points` rows is brought to those where it bends. InputError: no such file, no header, an unknown column
/// (with the known ones), a column or a quantity twice, an error of no column, a cell of the loading that is no number,
/// a strain that falls without unloading, fewer than two rows.
std::vector<Curve> read_curves(const std::string& path, const Selection& selection = {}, const Tell& tell = {});
/// The same from a text; `path` serves messages.
std::vector<Curve> parsed_curves(const std::string& text, const std::string& path, const Selection& selection = {},
                                 const Tell& tell = {});

/// Gives the points standard errors as repeated tests of laboratories have them (laboratory_scatter).
void assume_scatter(Curve& curve);
/// Those of a quantity in words: "4 % of each value and 1 % of the largest".
std::string laboratory_scatter(const std::string& quantity);

/// A test's last stage as a measured curve.
struct TestCurve {
  std::vector<double> y;  ///< at the abscissae of the measured one; NaN beyond its end
  Features features;      ///< up to the last of them
};
/// Only the rising part of the abscissa counts; a stress may rise from stages before the last.
TestCurve curve_of(const records::TestResult& test, int dimension, const Curve& like);

/// The points as targets of one curve; `test`: the name that begins theirs, "" for none.
std::vector<Target> targets_of(const Curve& curve, int number, const std::string& test = "");

}  // namespace rvelab::fit
