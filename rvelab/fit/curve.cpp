#include "rvelab/fit/curve.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
#include "rvelab/fit/column_kinds.hpp"
#include "rvelab/io/import/csv_table.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/shortened.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::fit {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string quoted(const std::string& name) { return "\"" + keys::shortened(io::printable(name)) + "\""; }

bool in_logarithm(const std::string& abscissa) { return abscissa != "strain"; }

/// Linear between the points of rising x, on the logarithm of a pressure.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at, bool logarithm) {
  const double slack = 1e-9 * std::abs(at);
  if (x.empty() || at < x.front() - slack || at > x.back() + slack) return nan;
  const auto above = std::lower_bound(x.begin() + 1, x.end() - 1, at);
  const auto k = std::size_t(above - x.begin());
  const double part =
      logarithm ? std::log(at / x[k - 1]) / std::log(x[k] / x[k - 1]) : (at - x[k - 1]) / (x[k] - x[k - 1]);
  return y[k - 1] + part * (y[k] - y[k - 1]);
}

/// Rows at which straight lines between few points leave least of the curves: one after the other where the curve that
/// is farthest off, over its range, is off most. Even spacing counts for a little, so that straight parts have points.
std::vector<std::size_t> bending_rows(const std::vector<double>& x, const std::vector<std::vector<double>>& curves) {
  constexpr double of_spacing = 0.02;
  std::vector<std::size_t> chosen{0, x.size() - 1};
  std::vector<double> ranges;
  for (const auto& y : curves) {
    const auto [low, high] = std::minmax_element(y.begin(), y.end());
    ranges.push_back(*high > *low ? *high - *low : 1);
  }
  while (chosen.size() < most_points) {
    std::pair<double, std::size_t> worst{0, 0};
    for (std::size_t gap = 0; gap + 1 < chosen.size(); ++gap) {
      const std::size_t a = chosen[gap], b = chosen[gap + 1];
      for (std::size_t k = a + 1; k < b; ++k) {
        const double part = (x[k] - x[a]) / (x[b] - x[a]);
        double off = of_spacing * std::min(x[k] - x[a], x[b] - x[k]) / (x.back() - x.front());
        for (std::size_t c = 0; c < curves.size(); ++c)
          off = std::max(off, std::abs(curves[c][k] - std::lerp(curves[c][a], curves[c][b], part)) / ranges[c]);
        worst = std::max(worst, {off, k}, [](const auto& one, const auto& other) { return one.first < other.first; });
      }
    }
    if (worst.first == 0) break;
    chosen.insert(std::lower_bound(chosen.begin(), chosen.end(), worst.second), worst.second);
  }
  return chosen;
}

double value_of(const records::Record& record, const std::string& quantity, int dimension) {
  if (quantity == "strain") return std::abs(record.strain);
  if (quantity == "axial_stress") return calibrate::principal_stresses(record.stress, dimension).major;
  const double p = mean_pressure(record.stress, dimension);
  if (quantity == "p") return p;
  if (quantity == "q_over_p") return deviatoric_stress(record.stress, dimension) / p;
  if (quantity == "deviator") return 2 * calibrate::principal_stresses(record.stress, dimension).t();
  if (quantity == "volumetric_strain") return 1 - record.deformation_gradient.determinant();
  return record.void_ratio;
}

Features features_of(const std::vector<double>& x, const std::vector<double>& y, const std::string& abscissa) {
  Features found;
  if (abscissa != "strain" || x.size() < 2) return found;
  const auto largest = std::max_element(y.begin(), y.end());
  found.largest = *largest;
  found.at_largest = x[std::size_t(largest - y.begin())];
  found.early = interpolated(x, y, Features::early_strain, false);
  found.last = y.back();
  return found;
}

/// A column that is read.
struct Chosen {
  std::size_t column = 0;
  ColumnKind kind;
};

/// Each column of the table, as its name says; those of errors are left to their curves.
std::vector<Chosen> all_columns(const io::CsvTable& table) {
  const auto& header = table.columns();
  std::vector<Chosen> chosen;
  for (std::size_t k = 0; k < header.size(); ++k) {
    const std::string& name = header[k];
    const std::string of = name.ends_with("_error") ? name.substr(0, name.size() - 6) : "";
    if (!of.empty() && std::find(header.begin() + 1, header.end(), of) == header.end())
      throw InputError(table.path() + ": the column " + quoted(name) +
                       " is the error of no column; allowed: that of a "
                       "curve beside it; name it as its curve, with _error behind");
    if (!of.empty() && k > 0) continue;
    const auto kind = column_kind(name);
    if (k == 0 && !(kind && may_be_abscissa(*kind)))
      throw InputError(table.path() + ": the first column is " + quoted(name) + "; allowed: " + known_columns(true) +
                       "; name the column with its unit, or choose columns (--column)");
    if (!kind || !may_be_curve(*kind))
      if (k > 0)
        throw InputError(table.path() + ": the column " + quoted(name) +
                         " is not known; allowed: " + known_columns(false) +
                         ", and each with _error behind it; name it with its unit, or choose the columns to read "
                         "(--column)");
    chosen.push_back({k, *kind});
  }
  return chosen;
}

/// Those that were asked for.
std::vector<Chosen> selected(const io::CsvTable& table, const std::vector<std::string>& columns) {
  std::vector<Chosen> chosen;
  for (const std::string& text : columns) {
    const auto equals = text.find('=');
    const std::string kind_name = text.substr(0, equals);
    const std::string name = equals == std::string::npos ? text : text.substr(equals + 1);
    const auto kind = column_kind(kind_name);
    const bool first = chosen.empty();
    if (!kind || !(first ? may_be_abscissa(*kind) : may_be_curve(*kind)))
      throw InputError(table.path() + ": the column asked for, " + quoted(text) + ", is no " +
                       (first ? "abscissa; allowed first: " : "curve; allowed: ") + known_columns(first) +
                       "; write KIND, or KIND=NAME for a column of another name");
    chosen.push_back({table.column({name}), *kind});
  }
  return chosen;
}

/// InputError for a stress without a unit, and for a quantity twice.
void expect_units(const io::CsvTable& table, const std::vector<Chosen>& columns) {
  const auto& header = table.columns();
  std::map<std::string, std::string> named;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto& [column, kind] = columns[k];
    if (kind.factor == 0)
      throw InputError(table.path() + ": the column " + quoted(header[column]) +
                       " has no unit; allowed: _Pa, _kPa or _MPa behind it, or [kPa]; write it, or name the column "
                       "as --column deviator_kPa=q does");
    if (k == 0) continue;
    if (const auto [first, fresh] = named.emplace(kind.quantity, header[column]); !fresh)
      throw InputError(table.path() + ": the columns " + first->second + " and " + header[column] +
                       " are one quantity twice; allowed: one column for each; remove one");
  }
}

/// Numbers of a column, in the units of the file.
std::vector<double> values_of(const io::CsvTable& table, std::size_t column) {
  std::vector<double> values;
  for (std::size_t row = 0; row < table.rows(); ++row) values.push_back(table.number(row, column));
  return values;
}

/// Rows between the ends that were asked for, without unloading; of a stress that is held, the last.
std::vector<std::size_t> rows_of(const io::CsvTable& table, const std::vector<double>& x, const Selection& selection,
                                 const Chosen& abscissa) {
  const auto& path = table.path();
  if (x.size() < 2) throw InputError(path + ": " + std::to_string(x.size()) + " rows; allowed: at least 2");
  const bool may_be_held = abscissa.kind.is_stress();
  const auto largest = std::size_t(std::max_element(x.begin(), x.end()) - x.begin());
  for (std::size_t k = 1; k < x.size(); ++k) {
    if (k > largest && may_be_held) break;  // unloading, and loading again
    const double step = k <= largest ? x[k] - x[k - 1] : x[k - 1] - x[k];
    if (!(step > 0 || (step == 0 && may_be_held)))
      throw InputError(table.location(k, abscissa.column) +
                       " does not rise; allowed: rising values; sort the rows, or leave unloading out");
  }
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < x.size() && x[k] >= x[k == 0 ? 0 : k - 1]; ++k) {
    if (x[k] < selection.from.value_or(x[k]) || x[k] > selection.to.value_or(x[k])) continue;
    if (!rows.empty() && x[rows.back()] == x[k]) rows.pop_back();
    rows.push_back(k);
  }
  if (rows.size() < 2)
    throw InputError(path + ": " + std::to_string(rows.size()) +
                     " rows are left between from and to, before the unloading; allowed: at least 2; they reach from " +
                     in_words(x.front()) + " to " + in_words(x[largest]));
  return rows;
}

/// The part of a column, in SI.
std::vector<double> part_of(const std::vector<double>& values, const std::vector<std::size_t>& rows, double factor) {
  std::vector<double> part;
  for (const std::size_t row : rows) part.push_back(factor * values[row]);
  return part;
}

void expect_finite(const io::CsvTable& table, const Curve& curve, std::size_t column) {
  for (std::size_t k = 0; k < curve.x.size(); ++k)
    if (!std::isfinite(curve.x[k]) || (in_logarithm(curve.abscissa) && !std::isnormal(curve.x[k])) ||
        !std::isfinite(curve.y[k]) || !std::isfinite(curve.error[k]))
      throw InputError(table.path() + ": " + table.columns()[column] + " has no finite value at " + curve.abscissa +
                       " = " + in_words(curve.x[k]) +
                       "; allowed: numbers of a test, not those at the ends of what a computer holds; correct them");
}

/// A strain over a stress counts from its first point.
void count_from_first(const std::string& quantity, std::vector<double>& y) {
  if (quantity != "strain" || y.empty()) return;
  const double first = y.front();
  for (double& value : y) value -= first;
}

std::vector<Curve> curves_in(const io::CsvTable& table, const Selection& selection) {
  const auto& header = table.columns();
  const auto& path = table.path();
  const std::vector<Chosen> columns =
      selection.columns.empty() ? all_columns(table) : selected(table, selection.columns);
  expect_units(table, columns);
  const std::vector<double> whole = values_of(table, columns[0].column);
  const std::vector<std::size_t> rows = rows_of(table, whole, selection, columns[0]);
  const ColumnKind& abscissa = columns[0].kind;
  const std::vector<double> x = part_of(whole, rows, abscissa.factor);
  if (in_logarithm(abscissa.quantity) && !(x.front() > 0))
    throw InputError(path + ": " + header[columns[0].column] +
                     " is not above 0; allowed: > 0; leave the row out, or begin above it (from)");
  if (columns.size() < 2)
    throw InputError(path + ": there is no column beside " + header[columns[0].column] +
                     "; allowed: " + known_columns(false));
  std::vector<std::vector<double>> values;
  for (std::size_t k = 1; k < columns.size(); ++k) {
    values.push_back(part_of(values_of(table, columns[k].column), rows, columns[k].kind.factor));
    count_from_first(columns[k].kind.quantity, values.back());
  }
  std::vector<double> spaced = x;
  if (in_logarithm(abscissa.quantity))
    for (double& value : spaced) value = std::log(value);
  std::vector<std::size_t> chosen(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) chosen[k] = k;
  if (x.size() > most_points) chosen = bending_rows(spaced, values);
  std::vector<Curve> curves;
  for (std::size_t k = 1; k < columns.size(); ++k) {
    const auto& y = values[k - 1];
    const auto own_error = std::find(header.begin(), header.end(), header[columns[k].column] + "_error");
    std::vector<double> error(y.size(), 0);
    if (own_error != header.end())
      error = part_of(values_of(table, std::size_t(own_error - header.begin())), rows, columns[k].kind.factor);
    Curve curve{columns[k].kind.quantity, abscissa.quantity, {}, {}, {}, features_of(x, y, abscissa.quantity)};
    for (const std::size_t row : chosen) {
      curve.x.push_back(x[row]);
      curve.y.push_back(y[row]);
      curve.error.push_back(error[row]);
    }
    expect_finite(table, curve, columns[k].column);
    curves.push_back(std::move(curve));
  }
  return curves;
}

/// Scatter of repeated tests: part of each value, part of the largest, and a constant, added as squares.
struct Scatter {
  double of_value = 0, of_largest = 0, constant = 0;
};
Scatter scatter_of(const std::string& quantity) {
  if (quantity == "volumetric_strain" || quantity == "strain") return {0.05, 0, 0.002};
  if (quantity == "void_ratio") return {0, 0, 0.01};
  return {0.04, 0.01, 0};
}

}  // namespace

std::vector<Curve> parsed_curves(const std::string& text, const std::string& path, const Selection& selection) {
  return curves_in(io::CsvTable(path, text), selection);
}

std::vector<Curve> read_curves(const std::string& path, const Selection& selection) {
  return parsed_curves(io::whole_text(path, "a CSV file with named columns"), path, selection);
}

void assume_scatter(Curve& curve) {
  const Scatter scatter = scatter_of(curve.name);
  double largest = 0;
  for (const double y : curve.y) largest = std::max(largest, std::abs(y));
  for (std::size_t k = 0; k < curve.y.size(); ++k)
    curve.error[k] = std::hypot(scatter.of_value * curve.y[k], scatter.of_largest * largest, scatter.constant);
}

std::string laboratory_scatter(const std::string& quantity) {
  const Scatter scatter = scatter_of(quantity);
  if (scatter.of_value == 0) return in_words(scatter.constant);
  return in_words(100 * scatter.of_value) + " % of each value and " +
         (scatter.constant > 0 ? in_words(scatter.constant) : in_words(100 * scatter.of_largest) + " % of the largest");
}

TestCurve curve_of(const records::TestResult& test, int dimension, const Curve& like) {
  std::vector<double> x, y;
  if (!test.records.empty()) {
    for (const records::Record& record : calibrate::last_stage(test)) {
      const double at = value_of(record, like.abscissa, dimension);
      if (!x.empty() && !(at > x.back())) continue;  // p wavers about its path
      x.push_back(at);
      y.push_back(value_of(record, like.name, dimension));
    }
  }
  TestCurve found;
  for (const double at : like.x)
    found.y.push_back(x.size() < 2 ? nan : interpolated(x, y, at, in_logarithm(like.abscissa)));
  count_from_first(like.name, found.y);
  const auto end = std::upper_bound(x.begin(), x.end(), like.x.back()) - x.begin();
  x.resize(std::size_t(end));
  y.resize(std::size_t(end));
  found.features = features_of(x, y, like.abscissa);
  return found;
}

std::vector<Target> targets_of(const Curve& curve, int number, const std::string& test) {
  std::vector<Target> targets;
  for (std::size_t k = 0; k < curve.x.size(); ++k)
    targets.push_back(
        {(test.empty() ? "" : test + ": ") + curve.name + " at " + curve.abscissa + " = " + in_words(curve.x[k]),
         curve.y[k], curve.error[k], number});
  return targets;
}

}  // namespace rvelab::fit
