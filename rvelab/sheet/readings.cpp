#include "rvelab/sheet/readings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/ensemble/measures.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/error.hpp"

namespace rvelab::sheet {
namespace {

bool same_pressure(double one, double other) {
  return (std::isnan(one) && std::isnan(other)) || std::abs(one - other) <= 0.02 * std::abs(one);
}

/// fit, and what the errors of the readings do to it together; NaN where no reading has one.
std::pair<double, double> with_error_of(const Readings& readings, const std::function<double(const Readings&)>& fit) {
  const double value = fit(readings);
  double error = 0;
  bool known = false;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    if (!std::isfinite(readings[k].error)) continue;
    Readings moved = readings;
    moved[k].value += moved[k].error;
    const double change = std::abs(fit(moved) - value);
    if (!std::isfinite(change)) continue;
    error += change;
    known = true;
  }
  return {value, known ? error : unknown};
}

/// One list for each value of `of`, in the order in which they come.
template <class Same>
std::vector<Readings> parted(const Readings& readings, Same same) {
  std::vector<Readings> parts;
  for (const Reading& reading : readings) {
    const auto part = std::find_if(parts.begin(), parts.end(),
                                   [&](const Readings& each) { return same(*each.front().test, *reading.test); });
    if (part == parts.end())
      parts.push_back({reading});
    else
      part->push_back(reading);
  }
  const auto place = [](const Readings& part) {
    const double pressure = part.front().test->pressure;
    return std::pair(part.front().test->density, std::isnan(pressure) ? -1 : pressure);
  };
  std::stable_sort(parts.begin(), parts.end(),
                   [&](const Readings& one, const Readings& other) { return place(one) < place(other); });
  return parts;
}

}  // namespace

double mean_of(const Readings& readings) {
  double sum = 0;
  for (const Reading& reading : readings) sum += reading.value;
  return readings.empty() ? unknown : sum / double(readings.size());
}

Number number_of(const About& about, const Readings& readings, const std::function<double(const Readings&)>& fit) {
  Number number;
  number.group = about.group;
  number.key = about.key;
  number.label = about.label;
  number.unit = about.unit;
  number.definition = about.definition;
  number.source = about.source;
  std::map<std::uint64_t, Readings> seeds;
  std::set<std::string> names;
  for (const Reading& reading : readings) {
    if (!std::isfinite(reading.value)) continue;
    seeds[reading.test->seed].push_back(reading);
    if (names.insert(reading.test->name).second) number.tests.push_back(reading.test->name);
  }
  std::vector<double> values, errors;
  for (const auto& [seed, own] : seeds) {
    const auto [value, error] = with_error_of(own, fit);
    values.push_back(std::isfinite(value) ? value : unknown);
    errors.push_back(std::isfinite(value) ? error : unknown);
  }
  const ensemble::Spread spread = ensemble::spread_of(values);
  number.mean = spread.mean;
  number.standard_error = spread.standard_error;
  number.low = spread.low;
  number.high = spread.high;
  number.calculation_error = ensemble::spread_of(errors).mean;
  return number;
}

bool add_number(Sheet& sheet, Number number) {
  if (!std::isfinite(number.mean)) return false;
  sheet.numbers.push_back(std::move(number));
  return true;
}

Test at_abscissa(const Test& test, double abscissa) {
  Test place;
  place.name = test.name;
  place.purpose = test.purpose;
  place.density = test.density;
  place.density_name = test.density_name;
  place.relative_density = test.relative_density;
  place.seed = test.seed;
  place.dimension = test.dimension;
  place.pressure = abscissa;
  return place;
}

std::vector<TestGroup> groups_of(const std::vector<Test>& tests, Purpose purpose) {
  Readings all;
  for (const Test& test : tests)
    if (test.purpose == purpose && !test.result.records.empty()) all.push_back({&test});
  std::vector<TestGroup> groups;
  for (const Readings& part : by_pressure(all)) {
    groups.emplace_back();
    for (const Reading& reading : part) groups.back().tests.push_back(reading.test);
  }
  return groups;
}

std::vector<Readings> by_density(const Readings& readings) {
  return parted(readings, [](const Test& one, const Test& other) { return one.density == other.density; });
}

std::vector<Readings> by_pressure(const Readings& readings) {
  return parted(readings, [](const Test& one, const Test& other) {
    return one.density == other.density && same_pressure(one.pressure, other.pressure);
  });
}

void add_by_density(Sheet& sheet, const About& about, const Readings& readings,
                    const std::function<double(const Readings&)>& fit) {
  for (const Readings& part : by_density(readings)) {
    Number number = number_of(about, part, fit);
    number.density_name = part.front().test->density_name;
    number.relative_density = part.front().test->relative_density;
    add_number(sheet, std::move(number));
  }
}

void add_by_pressure(Sheet& sheet, const About& about, const Readings& readings) {
  for (const Readings& part : by_pressure(readings)) {
    Number number = number_of(about, part);
    number.density_name = part.front().test->density_name;
    number.relative_density = part.front().test->relative_density;
    number.pressure = part.front().test->pressure;
    add_number(sheet, std::move(number));
  }
}

Straight straight_through(std::span<const double> x, std::span<const double> y) {
  const auto n = double(x.size());
  double middle = 0, mean = 0, variance = 0, product = 0, squares = 0;
  for (std::size_t k = 0; k < x.size(); ++k) middle += x[k] / n, mean += y[k] / n;
  for (std::size_t k = 0; k < x.size(); ++k) {
    squares += x[k] * x[k];
    variance += (x[k] - middle) * (x[k] - middle);
    product += (x[k] - middle) * (y[k] - mean);
  }
  if (x.size() < 2 || !(variance > 1e-12 * squares)) return {unknown, unknown};
  const double slope = product / variance;
  return {mean - slope * middle, slope};
}

Straight power_law(const Readings& readings, double reference) {
  std::vector<double> x, y;
  for (const Reading& reading : readings) {
    if (!(reading.value > 0) || !(reading.at > 0)) continue;
    x.push_back(std::log(reading.at / reference));
    y.push_back(std::log(reading.value));
  }
  // Abscissae that differ by what a test misses its pressure give no slope.
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  if (x.empty() || *high - *low < std::log(1.05)) return {unknown, unknown};
  const Straight line = straight_through(x, y);
  return {std::exp(line.intercept), line.slope};
}

double measure_of(const Test& test, std::string_view name) {
  const auto& all = ensemble::measures();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.name == name; });
  return ensemble::measured(test.protocol, test.result, test.dimension).at(std::size_t(found - all.begin()));
}

std::span<const records::Record> last_records(const Test& test) {
  return test.result.records.empty() ? std::span<const records::Record>() : calibrate::last_stage(test.result);
}

int axis_of(const Test& test) { return test.result.axis.size() == 1 ? test.result.axis[0] - 'x' : test.dimension - 1; }

double axial_stress(const Test& test, const records::Record& record) {
  return -record.stress(axis_of(test), axis_of(test));
}

double lateral_stress(const Test& test, const records::Record& record) {
  double sum = 0;
  for (int k = 0; k < test.dimension; ++k)
    if (k != axis_of(test)) sum -= record.stress(k, k) / (test.dimension - 1);
  return sum;
}

double stress_error(const Test& test, const records::Record& record) {
  return record.error_estimate > 0 ? record.error_estimate * std::abs(mean_pressure(record.stress, test.dimension))
                                   : unknown;
}

double angle_error_deg(const Test& test, const records::Record& record) {
  const calibrate::PrincipalStresses principal = calibrate::principal_stresses(record.stress, test.dimension);
  const double sine = principal.t() / principal.s();
  return stress_error(test, record) / principal.s() * (1 + sine) / std::sqrt(1 - sine * sine) * 180 / std::numbers::pi;
}

double half_interval(const Number& number) { return 0.5 * (number.high - number.low); }

std::string density_label(const Test& test) {
  return test.density_name.empty() ? "density " + std::to_string(test.density + 1) : test.density_name;
}

std::string pressure_label(double pressure) { return in_words(std::round(pressure / 10) / 100) + " kPa"; }

Series mean_series(const Readings& readings, double x_factor, double y_factor, const std::string& label) {
  constexpr About none{"", "", "", "", "", ""};
  Series series;
  series.label = label;
  series.line = false;
  for (const Readings& part : by_pressure(readings)) {
    const Number number = number_of(none, part);
    if (!std::isfinite(number.mean)) continue;
    double at = 0;
    for (const Reading& reading : part) at += reading.at / double(part.size());
    series.x.push_back(x_factor * at);
    series.y.push_back(y_factor * number.mean);
    series.error.push_back(y_factor * half_interval(number));
  }
  return series;
}

}  // namespace rvelab::sheet
