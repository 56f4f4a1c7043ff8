// Values that are read off tests, with their errors, and numbers of the sheet that are made of them. Internal to the
// module.
//
// Specimens are told apart by their seed: what takes several tests (a fit over densities and pressures) is made once
// for each seed, and mean, standard error and interval (Student's t) are those of the seeds. The error of calculation
// of a number is sum |d number/d value| error over the values, the largest that errors of one size can make together.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rvelab/sheet/sheet.hpp"

namespace rvelab::sheet {

inline constexpr double reference_pressure = 100e3;  ///< p_ref, Pa

/// A value of one test.
struct Reading {
  const Test* test = nullptr;
  double value = unknown;
  double error = unknown;  ///< of calculation; NaN: not estimated
  double at = unknown;     ///< abscissa, where a fit takes one
};
using Readings = std::vector<Reading>;

/// What a number is, whatever its value.
struct About {
  const char *group, *key, *label, *unit, *definition, *source;
};

double mean_of(const Readings& readings);

/// `fit` of the readings of each seed, NaN where they do not suffice. One density or one pressure alone: the number
/// says which.
Number number_of(const About& about, const Readings& readings,
                 const std::function<double(const Readings&)>& fit = mean_of);

/// Appends it if it has a value.
bool add_number(Sheet& sheet, Number number);

/// The name, density and seed of a test without its records, at another abscissa than its pressure: by_pressure() and
/// mean_series() then go by this one.
Test at_abscissa(const Test& test, double abscissa);

/// Tests of one purpose at one density and pressure, the seeds in their order.
struct TestGroup {
  std::vector<const Test*> tests;
  const Test& first() const { return *tests.front(); }
};
std::vector<TestGroup> groups_of(const std::vector<Test>& tests, Purpose purpose);

/// The readings of one density each, in the order of the densities; those of one density and pressure each.
std::vector<Readings> by_density(const Readings& readings);
std::vector<Readings> by_pressure(const Readings& readings);
/// One number for each of them.
void add_by_density(Sheet& sheet, const About& about, const Readings& readings,
                    const std::function<double(const Readings&)>& fit = mean_of);
void add_by_pressure(Sheet& sheet, const About& about, const Readings& readings);

/// Slope and intercept of the least squares line; NaN from fewer than two abscissae.
struct Straight {
  double intercept, slope;
};
Straight straight_through(std::span<const double> x, std::span<const double> y);

/// Of y = a (x/reference)^slope, by the logarithms of positive readings: `intercept` is a. NaN where the abscissae
/// differ by less than 5 %.
Straight power_law(const Readings& readings, double reference);

/// The value of a measure (ensemble::measures()).
double measure_of(const Test& test, std::string_view name);

/// The records of the last stage; empty where there are none.
std::span<const records::Record> last_records(const Test& test);
/// Axis that the last stage shortens.
int axis_of(const Test& test);
/// Axial and mean lateral stress of a record, compression positive, Pa.
double axial_stress(const Test& test, const records::Record& record);
double lateral_stress(const Test& test, const records::Record& record);
/// Error estimate of the stresses of a record, Pa; NaN where none was made.
double stress_error(const Test& test, const records::Record& record);
/// Of the mobilised friction angle, degrees.
double angle_error_deg(const Test& test, const records::Record& record);

/// Half of the 95 % interval of the mean over seeds; NaN from a single one.
double half_interval(const Number& number);

/// "dense"; "dense, 100 kPa"; of no density: "100 kPa".
std::string density_label(const Test& test);
std::string pressure_label(double pressure);

/// Means at each density and pressure as a series: x is the pressure of the readings (mean of `at`) times `x_factor`.
Series mean_series(const Readings& readings, double x_factor, double y_factor, const std::string& label);

}  // namespace rvelab::sheet
