// What fit() has to know of a model, and what is read off tests for its first guesses.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/models/element.hpp"

namespace rvelab::models {

using Tests = std::vector<ElementTest>;
using Numbers = std::map<std::string, double>;

/// A parameter before it is fitted. A value that is not fitted is taken as it is.
struct Entry {
  std::string name, unit, meaning;
  double value;      ///< first guess, or what it is
  double low, high;  ///< allowed
  Origin origin;
  bool logarithmic;  ///< searched by its logarithm

  bool fitted() const { return origin == Origin::fitted; }
};

struct Description {
  std::string key, title;
  /// What the fitted tests lack, as the end of "... needs "; "": nothing.
  std::string (*missing)(const Tests&);
  std::vector<Entry> (*parameters)(const Tests&, const Numbers&);
  std::unique_ptr<Law> (*law)(const std::vector<double>& values);
  /// Values that follow from others; null: none.
  void (*tie)(std::vector<double>& values);
  /// What a user of these values has to know; null, or "": nothing.
  std::string (*warning)(const std::vector<double>& values);
  bool softens = true;        ///< false: a drained test is fitted to twice the strain of its largest q
  bool cyclic_shear = false;  ///< it is calculated there
};

const Description& mohr_coulomb();
const Description& hardening_soil_small();
const Description& norsand();
const Description& hypoplasticity();

constexpr double p_ref = 1e5;  ///< Pa

/// The number of that key, else `otherwise`.
double number_or(const Numbers& numbers, const std::string& key, double otherwise);
bool has_number(const Numbers& numbers, const std::string& key);
/// Origin::sheet where there is such a number.
Origin sheet_or(const Numbers& numbers, const std::string& key, Origin otherwise);

Tests of_loading(const Tests& tests, Loading loading);
/// Drained and undrained ones.
Tests shear_tests(const Tests& tests);
/// True if the tests start at different pressures, a factor of 1.2 at least.
bool several_pressures(const Tests& tests);

/// Mean over drained and undrained tests of the largest mobilised friction angle.
double largest_friction_angle_deg(const Tests& tests);
/// M = q/p at the ends of drained and undrained tests, mean.
double stress_ratio_at_the_end(const Tests& tests);
double void_ratio_at_the_end(const ElementTest& test);

/// Secant modulus at half of the largest q of drained tests, as E = at_100_kPa (p0/100 kPa)^exponent.
struct SecantModulus {
  double at_100_kPa, exponent;
};
SecantModulus secant_modulus(const Tests& tests);

/// Steepest of the secants d(sigma_a)/d(eps_a) at about sigma_a = 100 kPa (or the lowest stress above) of first loading
/// in oedometers, brought to 100 kPa by the exponent; NaN without one.
double oedometer_modulus(const Tests& tests, double exponent);

}  // namespace rvelab::models
