// A measured curve as targets: read from CSV, brought to a few abscissae, and the same curve of a test.
//
// The header names the columns, each with its unit at its end: the abscissa first, then one or more curves over it,
// each with its standard error if it has one (NAME_error). Compression is positive.
//   abscissa   axial_strain, shear_strain (1, or _percent), p_Pa (_kPa, _MPa; interpolated in its logarithm)
//   curves     q_over_p, deviator_Pa (sigma_1 - sigma_3; _kPa, _MPa), volumetric_strain (1, or _percent), void_ratio
#pragma once

#include <span>
#include <string>
#include <vector>

#include "rvelab/fit/search.hpp"
#include "rvelab/records/record.hpp"

namespace rvelab::fit {

struct Curve {
  std::string name;                 ///< of the column, without its unit
  std::string abscissa;             ///< "strain" or "p"
  std::vector<double> x, y, error;  ///< SI; at most `most_points` of the measured range
};

inline constexpr std::size_t most_points = 12;

/// The curves of a CSV file (io/import/csv_table.hpp: semicolons, decimal commas, quotation marks, `sep=`). InputError:
/// no such file, an unknown column (with the known ones), a column or a quantity twice, an error of no column, a value
/// that is no number, an abscissa that does not rise, fewer than two rows.
std::vector<Curve> read_curves(const std::string& path);
/// The same from a text; `path` serves messages.
std::vector<Curve> parsed_curves(const std::string& text, const std::string& path);

/// The curve of a test's last stage at the abscissae of a measured one; NaN beyond its end. Only the rising part of the
/// abscissa counts.
std::vector<double> curve_of(const records::TestResult& test, int dimension, const Curve& like);

/// The points as targets of one curve.
std::vector<Target> targets_of(const Curve& curve, int number);

}  // namespace rvelab::fit
