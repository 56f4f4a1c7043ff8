#include "rvelab/fit/curve.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/import/csv_table.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/shortened.hpp"
#include "rvelab/measure/measures.hpp"

namespace rvelab::fit {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// What a column is: its quantity, and the factor that brings it to SI.
struct Column {
  std::string quantity;
  double factor = 1;
  bool abscissa = false;
};

const std::map<std::string, Column>& columns() {
  static const std::map<std::string, Column> all{{"axial_strain", {"strain", 1, true}},
                                                 {"axial_strain_percent", {"strain", 0.01, true}},
                                                 {"shear_strain", {"strain", 1, true}},
                                                 {"shear_strain_percent", {"strain", 0.01, true}},
                                                 {"p_Pa", {"p", 1, true}},
                                                 {"p_kPa", {"p", 1e3, true}},
                                                 {"p_MPa", {"p", 1e6, true}},
                                                 {"q_over_p", {"q_over_p", 1}},
                                                 {"deviator_Pa", {"deviator", 1}},
                                                 {"deviator_kPa", {"deviator", 1e3}},
                                                 {"deviator_MPa", {"deviator", 1e6}},
                                                 {"volumetric_strain", {"volumetric_strain", 1}},
                                                 {"volumetric_strain_percent", {"volumetric_strain", 0.01}},
                                                 {"void_ratio", {"void_ratio", 1}}};
  return all;
}

std::string known_columns(bool abscissa) {
  std::string text;
  for (const auto& [name, column] : columns())
    if (column.abscissa == abscissa) text += (text.empty() ? "" : ", ") + name;
  return text;
}

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

/// Few enough abscissae over the measured range.
std::vector<double> abscissae(const std::vector<double>& x, bool logarithm) {
  if (x.size() <= most_points) return x;
  std::vector<double> chosen;
  for (std::size_t k = 0; k < most_points; ++k) {
    const double part = double(k) / double(most_points - 1);
    chosen.push_back(logarithm ? x.front() * std::pow(x.back() / x.front(), part)
                               : x.front() + part * (x.back() - x.front()));
  }
  return chosen;
}

double value_of(const records::Record& record, const std::string& quantity, int dimension) {
  if (quantity == "strain") return std::abs(record.strain);
  const double p = mean_pressure(record.stress, dimension);
  if (quantity == "p") return p;
  if (quantity == "q_over_p") return deviatoric_stress(record.stress, dimension) / p;
  if (quantity == "deviator") return 2 * calibrate::principal_stresses(record.stress, dimension).t();
  if (quantity == "volumetric_strain") return 1 - record.deformation_gradient.determinant();
  return record.void_ratio;
}

}  // namespace

namespace {

/// Numbers of a column, in the units of the file.
std::vector<double> values_of(const io::CsvTable& table, std::size_t column) {
  std::vector<double> values;
  for (std::size_t row = 0; row < table.rows(); ++row) values.push_back(table.number(row, column));
  return values;
}

/// What each column is. InputError: the first is no abscissa, one is unknown, a quantity twice, an error of no column.
std::vector<Column> kinds_of(const io::CsvTable& table) {
  const auto& header = table.columns();
  const auto kind = [&](const std::string& name) {
    const auto found = columns().find(name);
    return found == columns().end() ? Column{} : found->second;
  };
  const auto quoted = [](const std::string& name) { return "\"" + keys::shortened(io::printable(name)) + "\""; };
  if (!kind(header[0]).abscissa)
    throw InputError(table.path() + ": the first column is " + quoted(header[0]) + "; allowed: " + known_columns(true) +
                     "; name the column with its unit");
  std::vector<Column> kinds;
  std::map<std::string, std::string> named;
  for (const std::string& name : header) {
    const std::string of = name.ends_with("_error") ? name.substr(0, name.size() - 6) : "";
    if (!of.empty() && std::find(header.begin() + 1, header.end(), of) == header.end())
      throw InputError(table.path() + ": the column " + quoted(name) +
                       " is the error of no column; allowed: that of a "
                       "curve beside it; name it as its curve, with _error behind");
    kinds.push_back(of.empty() ? kind(name) : Column{});
    const Column& column = kinds.back();
    if (!of.empty() || kinds.size() == 1) continue;
    if (column.quantity.empty() || column.abscissa)
      throw InputError(table.path() + ": the column " + quoted(name) + " is not known; allowed: " +
                       known_columns(false) + ", and each with _error behind it; name it with its unit");
    if (const auto [first, fresh] = named.emplace(column.quantity, name); !fresh)
      throw InputError(table.path() + ": the columns " + first->second + " and " + name +
                       " are one quantity twice; allowed: one column for each; remove one");
  }
  return kinds;
}

std::vector<Curve> curves_in(const io::CsvTable& table) {
  const auto& header = table.columns();
  const auto& path = table.path();
  const std::vector<Column> kinds = kinds_of(table);
  std::vector<double> x = values_of(table, 0);
  for (double& value : x) value *= kinds[0].factor;
  if (x.size() < 2) throw InputError(path + ": " + std::to_string(x.size()) + " rows; allowed: at least 2");
  for (std::size_t k = 1; k < x.size(); ++k)
    if (!(x[k] > x[k - 1]))
      throw InputError(table.location(k, 0) +
                       " does not rise; allowed: rising values; sort the rows, or leave unloading out");
  const bool logarithm = kinds[0].quantity == "p";
  if (logarithm && !(x.front() > 0)) throw InputError(path + ": p is not above 0; allowed: p > 0; leave the row out");
  std::vector<Curve> curves;
  for (std::size_t k = 1; k < header.size(); ++k) {
    const Column& column = kinds[k];
    if (column.quantity.empty()) continue;
    const std::string error_name = header[k] + "_error";
    const auto own_error = std::find(header.begin(), header.end(), error_name);
    const std::vector<double> y = values_of(table, k);
    std::vector<double> error(y.size(), 0);
    if (own_error != header.end()) error = values_of(table, std::size_t(own_error - header.begin()));
    Curve curve{column.quantity, kinds[0].quantity, abscissae(x, logarithm), {}, {}};
    for (const double at : curve.x) {
      curve.y.push_back(column.factor * interpolated(x, y, at, logarithm));
      curve.error.push_back(column.factor * interpolated(x, error, at, logarithm));
      if (!std::isfinite(curve.y.back()) || !std::isfinite(curve.error.back()))
        throw InputError(path + ": " + header[k] + " has no finite value at " + curve.abscissa + " = " + in_words(at) +
                         "; allowed: numbers of a test, not those at the ends of what a computer holds; correct them");
    }
    curves.push_back(curve);
  }
  if (curves.empty())
    throw InputError(path + ": there is no column beside " + header[0] + "; allowed: " + known_columns(false));
  return curves;
}

}  // namespace

std::vector<Curve> parsed_curves(const std::string& text, const std::string& path) {
  return curves_in(io::CsvTable(path, text));
}

std::vector<Curve> read_curves(const std::string& path) {
  return parsed_curves(io::whole_text(path, "a CSV file with named columns"), path);
}

std::vector<double> curve_of(const records::TestResult& test, int dimension, const Curve& like) {
  std::vector<double> x, y;
  if (!test.records.empty()) {
    for (const records::Record& record : calibrate::last_stage(test)) {
      const double at = value_of(record, like.abscissa, dimension);
      if (!x.empty() && !(at > x.back())) continue;  // p wavers about its path
      x.push_back(at);
      y.push_back(value_of(record, like.name, dimension));
    }
  }
  std::vector<double> found;
  for (const double at : like.x) found.push_back(x.size() < 2 ? nan : interpolated(x, y, at, like.abscissa == "p"));
  return found;
}

std::vector<Target> targets_of(const Curve& curve, int number) {
  std::vector<Target> targets;
  for (std::size_t k = 0; k < curve.x.size(); ++k)
    targets.push_back(
        {curve.name + " at " + curve.abscissa + " = " + in_words(curve.x[k]), curve.y[k], curve.error[k], number});
  return targets;
}

}  // namespace rvelab::fit
