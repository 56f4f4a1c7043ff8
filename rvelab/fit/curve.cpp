#include "rvelab/fit/curve.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
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

std::vector<std::string> cells_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    const auto first = cell.find_first_not_of(" \t"), last = cell.find_last_not_of(" \t");
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

/// Numbers by column name, all of one length.
using Table = std::vector<std::vector<double>>;

Table numbers_in(std::istringstream& lines, const std::vector<std::string>& header, const std::string& path,
                 long number) {
  Table table(header.size());
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty() || line[0] == '#' || line == "\r") continue;
    const std::vector<std::string> cells = cells_of(line);
    const std::string place = path + ":" + std::to_string(number) + ": ";
    if (cells.size() != header.size())
      throw InputError(place + std::to_string(cells.size()) + " values; allowed: " + std::to_string(header.size()) +
                       ", as the header has; correct the line");
    for (std::size_t k = 0; k < cells.size(); ++k) {
      double value = 0;
      const auto [end, error] = std::from_chars(cells[k].data(), cells[k].data() + cells[k].size(), value);
      if (error != std::errc() || end != cells[k].data() + cells[k].size() || !std::isfinite(value))
        throw InputError(place + header[k] + " = \"" + cells[k] + "\" is no number; allowed: a finite number");
      table[k].push_back(value);
    }
  }
  return table;
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

std::vector<Curve> parsed_curves(const std::string& text, const std::string& path) {
  std::istringstream lines(text);
  std::string line;
  long number = 0;
  while (std::getline(lines, line)) {
    ++number;
    if (!line.empty() && line[0] != '#') break;
  }
  const std::vector<std::string> header = cells_of(line);
  const auto kind = [&](const std::string& name) {
    const auto found = columns().find(name);
    return found == columns().end() ? Column{} : found->second;
  };
  if (header.empty() || !kind(header[0]).abscissa)
    throw InputError(path + ": the first column is \"" + (header.empty() ? "" : header[0]) +
                     "\"; allowed: " + known_columns(true) + "; name the column with its unit");
  const Table table = numbers_in(lines, header, path, number);
  std::vector<double> x = table[0];
  for (double& value : x) value *= kind(header[0]).factor;
  if (x.size() < 2) throw InputError(path + ": " + std::to_string(x.size()) + " rows; allowed: at least 2");
  for (std::size_t k = 1; k < x.size(); ++k)
    if (!(x[k] > x[k - 1]))
      throw InputError(path + ": " + header[0] + " does not rise at " + in_words(table[0][k]) +
                       "; allowed: rising values; sort the rows, or leave unloading out");
  const bool logarithm = kind(header[0]).quantity == "p";
  if (logarithm && !(x.front() > 0)) throw InputError(path + ": p is not above 0; allowed: p > 0; leave the row out");
  std::vector<Curve> curves;
  for (std::size_t k = 1; k < header.size(); ++k) {
    if (header[k].ends_with("_error")) continue;
    const Column column = kind(header[k]);
    if (column.quantity.empty() || column.abscissa)
      throw InputError(path + ": the column \"" + header[k] + "\" is not known; allowed: " + known_columns(false) +
                       ", and each with _error behind it; name it with its unit");
    const auto own_error = std::find(header.begin(), header.end(), header[k] + "_error");
    Curve curve{column.quantity, kind(header[0]).quantity, abscissae(x, logarithm), {}, {}};
    for (const double at : curve.x) {
      curve.y.push_back(column.factor * interpolated(x, table[k], at, logarithm));
      const bool known = own_error != header.end();
      curve.error.push_back(
          known ? column.factor * interpolated(x, table[std::size_t(own_error - header.begin())], at, logarithm) : 0);
    }
    curves.push_back(curve);
  }
  if (curves.empty())
    throw InputError(path + ": there is no column beside " + header[0] + "; allowed: " + known_columns(false));
  return curves;
}

std::vector<Curve> read_curves(const std::string& path) {
  std::ifstream input(path, std::ios::binary);
  if (!input) throw InputError(path + ": no such file; allowed: a CSV file with named columns");
  return parsed_curves({std::istreambuf_iterator<char>(input), {}}, path);
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
