#include "rvelab/fit/curve.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
#include "rvelab/fit/chosen_columns.hpp"
#include "rvelab/fit/loading.hpp"
#include "rvelab/io/import/text.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::fit {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool in_logarithm(const std::string& abscissa) { return abscissa != "strain"; }

/// Linear between the points of rising x, on the logarithm of a pressure. A test begins at its pressure within a
/// tolerance: a pressure that is missed by less is taken as its first.
double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at, bool logarithm) {
  const double slack = 1e-9 * std::abs(at), slack_before = logarithm ? 0.01 * at : slack;
  if (x.empty() || at < x.front() - slack_before || at > x.back() + slack) return nan;
  if (logarithm) at = std::max(at, x.front());
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

/// Driving strain of a record; of a path, which counts another one, the axial strain.
double strain_of(const records::Record& record, const std::string& axis) {
  const double driving = std::abs(record.strain);
  if (axis.size() != 1) return driving;
  const int a = axis[0] - 'x';
  const double axial = std::abs(1 - record.deformation_gradient(a, a));
  return std::abs(driving - axial) > 1e-9 + 1e-6 * axial ? axial : driving;
}

double value_of(const records::Record& record, const std::string& quantity, const std::string& axis, int dimension) {
  if (quantity == "strain") return strain_of(record, axis);
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

/// Rows of the table up to the last in which a curve has a cell: beside a longer test, or an abscissa that goes on.
std::size_t rows_of_test(const MeasuredTable& table, const std::vector<Chosen>& columns) {
  std::size_t end = 0;
  for (std::size_t k = 1; k < columns.size(); ++k)
    for (std::size_t row = table.rows(); row > end; --row)
      if (!table.is_empty(row - 1, columns[k].column)) end = row;
  const bool is_cut = end > 0 && end + 1 == table.rows() && !table.is_empty(end, columns[0].column) &&
                      table.ends_before(end, columns[1].column);
  return is_cut ? end + 1 : end;  // a file that ends within a line
}

Readings readings_of(const MeasuredTable& table, const std::vector<Chosen>& columns, const Selection& selection) {
  Readings readings{{}, {}, columns[0].kind.quantity == "strain", selection.from, selection.to};
  const std::size_t rows = rows_of_test(table, columns);
  const auto deviator = std::find_if(columns.begin() + 1, columns.end(), [](const Chosen& each) {
    return each.kind.quantity == "deviator" || each.kind.quantity == "q_over_p";
  });
  for (std::size_t row = 0; row < rows; ++row) {
    readings.x.push_back(table.number_or_nan(row, columns[0].column));
    if (readings.is_strain && deviator != columns.end())
      readings.deviator.push_back(table.number_or_nan(row, deviator->column));
  }
  return readings;
}

/// InputError for a cell within the loading that is no number, and for too few rows.
void expect_loading(const MeasuredTable& table, const Readings& readings, const Loading& loading, std::size_t column) {
  const auto& x = readings.x;
  const auto& points = loading.points;
  const bool enough = points.size() > 1;
  for (std::size_t row = enough ? points.front().rows.front() : 0;
       row < (enough ? points.back().rows.back() : x.size()); ++row)
    if (!std::isfinite(x[row]) && (enough || !table.is_empty(row, column))) table.number(row, column);
  if (loading.backwards)
    throw InputError(table.location(*loading.backwards, column) +
                     " does not rise, and the deviator does not fall as in unloading; allowed: a strain that rises but "
                     "for its sensor's step; where the sensor was set back add what it had, or sort the rows");
  if (enough) return;
  double first = nan, largest = nan;
  for (const double value : x) {
    if (std::isnan(first)) first = value;
    largest = std::fmax(largest, value);
  }
  throw InputError(table.path() + ": " + std::to_string(points.size()) +
                   " rows are left between from and to, before the unloading, where " + table.names()[column] +
                   " rises; allowed: at least 2; it reaches from " + in_words(first) + " to " + in_words(largest) +
                   (x.size() > 1 && largest == first
                        ? "; compression is positive: if it falls from the start, change the sign of the column"
                        : ""));
}

void tell_of(const MeasuredTable& table, const Loading& loading, std::size_t column, const Tell& tell) {
  if (!tell) return;
  const std::string& name = table.names()[column];
  const auto say = [&](const std::string& what) { tell(table.path() + ": " + what); };
  const auto rows = [&](const std::vector<std::size_t>& list, const std::string& what) {
    if (!list.empty()) say(what + ", " + table.lines_in_words(list));
  };
  for (const std::string& note : table.notes()) say(note);
  const auto joined = std::count_if(loading.points.begin(), loading.points.end(),
                                    [](const auto& each) { return each.rows.size() > 1; });
  rows(loading.before, "left out before contact or load");
  if (loading.counts_from_contact)
    say("strain counts from " + table.location(loading.contact, column) + ", where the deviator begins to rise");
  rows(loading.joined, std::to_string(loading.joined.size()) + " rows in which " + name +
                           " changes by no more than a sensor's step are joined to " + std::to_string(joined));
  rows(loading.glitches, "left out, since " + name + " stands out for one row");
  rows(loading.unloading, "left out, since the machine stood still or unloaded");
  rows(loading.after, "left out as the end of the test, after the largest " + name);
}

/// The values of a column at the points, in SI.
std::vector<double> values_at(const MeasuredTable& table, const Readings& readings, const Loading& loading,
                              std::size_t column, double factor) {
  std::vector<double> values;
  for (const LoadingPoint& point : loading.points) {
    const auto& rows = point.rows;
    const auto is_held = [&] {
      return std::all_of(rows.begin(), rows.end(),
                         [&](std::size_t row) { return readings.x[row] == readings.x[rows.front()]; });
    };
    const bool last = !readings.is_strain && (rows.size() > 2 || is_held());
    double value = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double own = table.number(rows[k], column);
      value = last ? own : value + (own - value) / double(k + 1);
    }
    values.push_back(factor * value);
  }
  return values;
}

/// Adds the rows behind the loading, of a stress, as long as it falls and has a value.
void add_unloading(Curve& curve, const MeasuredTable& table, const Readings& readings, const Loading& loading,
                   const std::vector<Chosen>& columns, std::size_t k) {
  if (readings.is_strain) return;
  const auto first = table.number_or_nan(loading.points.front().rows.back(), columns[k].column);
  double before = loading.points.back().x;
  for (const std::size_t row : loading.after) {
    const double x = readings.x[row], y = table.number_or_nan(row, columns[k].column);
    if (!(x <= before) || !(x > 0) || !std::isfinite(y)) return;
    before = x;
    curve.unloaded_x.push_back(columns[0].kind.factor * x);
    curve.unloaded_y.push_back(columns[k].kind.factor * (curve.name == "strain" ? y - first : y));
  }
}

void expect_finite(const MeasuredTable& table, const Curve& curve, std::size_t column) {
  for (std::size_t k = 0; k < curve.x.size(); ++k)
    if (!std::isfinite(curve.x[k]) || (in_logarithm(curve.abscissa) && !std::isnormal(curve.x[k])) ||
        !std::isfinite(curve.y[k]) || !std::isfinite(curve.error[k]))
      throw InputError(table.path() + ": " + table.names()[column] + " has no finite value at " + curve.abscissa +
                       " = " + in_words(curve.x[k]) +
                       "; allowed: numbers of a test, not those at the ends of what a computer holds; correct them");
}

void count_from_first(std::vector<double>& y) {
  if (y.empty()) return;
  const double first = y.front();
  for (double& value : y) value -= first;
}

std::vector<Curve> curves_in(MeasuredTable& table, const Selection& selection, const Tell& tell) {
  const std::vector<Chosen> columns = chosen_columns(table, selection.columns);
  const ColumnKind& abscissa = columns[0].kind;
  const Readings readings = readings_of(table, columns, selection);
  const Loading loading = loading_of(readings);
  expect_loading(table, readings, loading, columns[0].column);
  const double origin = loading.counts_from_contact ? loading.points.front().x : 0;
  std::vector<double> x;
  for (const LoadingPoint& point : loading.points) x.push_back(abscissa.factor * (point.x - origin));
  if (in_logarithm(abscissa.quantity) && !(x.front() > 0))
    throw InputError(table.location(loading.points.front().rows.front(), columns[0].column) +
                     " is not above 0; allowed: > 0; leave the row out, or begin above it (from)");
  std::vector<std::vector<double>> values;
  for (std::size_t k = 1; k < columns.size(); ++k) {
    values.push_back(values_at(table, readings, loading, columns[k].column, columns[k].kind.factor));
    const std::string& quantity = columns[k].kind.quantity;
    if (quantity == "strain" || (quantity == "volumetric_strain" && loading.counts_from_contact))
      count_from_first(values.back());
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
    std::vector<double> error(y.size(), 0);
    if (columns[k].error) error = values_at(table, readings, loading, *columns[k].error, columns[k].kind.factor);
    Curve curve{
        columns[k].kind.quantity, abscissa.quantity, {}, {}, {}, features_of(x, y, abscissa.quantity), table.path()};
    for (const std::size_t row : chosen) {
      curve.x.push_back(x[row]);
      curve.y.push_back(y[row]);
      curve.error.push_back(error[row]);
    }
    expect_finite(table, curve, columns[k].column);
    curve.all_x = x;
    curve.all_y = y;
    add_unloading(curve, table, readings, loading, columns, k);
    curves.push_back(std::move(curve));
  }
  tell_of(table, loading, columns[0].column, tell);
  return curves;
}

/// Puts the records of earlier stages in front that rise straight to the last: an oedometer test that measures its
/// stiffness first has left its pressure when its last stage begins. Strain goes on from stage to stage.
void begin_earlier(const records::TestResult& test, int dimension, const Curve& like, std::vector<double>& x,
                   std::vector<double>& y) {
  if (x.empty()) return;
  const auto& all = test.records;
  double behind = 0;  // strain that is to come up to the last stage
  for (std::size_t k = all.size() - calibrate::last_stage(test).size(); k > 0; --k) {
    const records::Record& record = all[k - 1];
    const double at = value_of(record, like.abscissa, test.axis, dimension);
    if (!(at <= x.front())) return;
    if (record.stage != all[k].stage) behind += std::abs(record.strain);
    if (at == x.front()) continue;  // a stage begins with the record that ended the one before
    x.insert(x.begin(), at);
    y.insert(y.begin(), value_of(record, like.name, test.axis, dimension) - (like.name == "strain" ? behind : 0));
  }
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

std::vector<Curve> parsed_curves(const std::string& text, const std::string& path, const Selection& selection,
                                 const Tell& tell) {
  MeasuredTable table(path, text, known_header(selection.columns));
  return curves_in(table, selection, tell);
}

std::vector<Curve> read_curves(const std::string& path, const Selection& selection, const Tell& tell) {
  return parsed_curves(io::whole_text(path, "a CSV file with named columns"), path, selection, tell);
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
      const double at = value_of(record, like.abscissa, test.axis, dimension);
      if (!x.empty() && !(at > x.back())) continue;  // p wavers about its path
      x.push_back(at);
      y.push_back(value_of(record, like.name, test.axis, dimension));
    }
  }
  if (in_logarithm(like.abscissa)) begin_earlier(test, dimension, like, x, y);
  TestCurve found;
  for (const double at : like.x)
    found.y.push_back(x.size() < 2 ? nan : interpolated(x, y, at, in_logarithm(like.abscissa)));
  if (like.name == "strain") count_from_first(found.y);
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
