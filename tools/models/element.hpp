// A material element in triaxial conditions: stress and strain along a test, from the rate equations of a law.
// Compression positive, Pa. Strain is natural here, so that de = -(1 + e) d(eps_v); that of tests, 1 - F_aa, is
// converted.
#pragma once

#include <array>
#include <string>

#include "tools/models/models.hpp"

namespace rvelab::models {

/// Axial stress and strain (a), radial ones (r), and what the law remembers.
struct Element {
  double sigma_a, sigma_r;
  double eps_a = 0, eps_r = 0;
  double e = 0;
  std::array<double, 5> memory{};

  double p() const { return (sigma_a + 2 * sigma_r) / 3; }
  double q() const { return sigma_a - sigma_r; }
};

/// A direction of strain: rates of eps_a and eps_r.
struct StrainRate {
  double a, r;
  double volumetric() const { return a + 2 * r; }
};

struct Rate {
  double sigma_a, sigma_r;
  std::array<double, 5> memory{};
};

/// A constitutive law, independent of rate: its rates are proportional to the strain rate.
class Law {
 public:
  virtual ~Law() = default;
  /// Fills the memory of an element at isotropic stress that was never loaded beyond it.
  virtual void start(Element&) const {}
  virtual Rate rate(const Element&, StrainRate) const = 0;
  /// The strain reverses.
  virtual void reverse(Element&) const {}
  /// Brings an element back to its yield surfaces after a step.
  virtual void settle(Element&) const {}
  /// Shear stress of first loading in simple shear at constant mean stress p, Pa; NaN: the law has none.
  virtual double shear_stress(double /*gamma*/, double /*p*/) const { return unknown; }
};

struct Calculation {
  ElementTest test;    ///< rows as those of the test that is calculated
  std::string remark;  ///< why it stops before the end, with the last state held from there; "": it does not
};

/// The test by the law. Drained and undrained tests follow the axial strain of the rows, an oedometer their axial
/// stress, isotropic compression their mean stress. Cyclic shear: first loading by Law::shear_stress, after each
/// reversal twice as large (Masing 1926). Rows must be finite.
Calculation calculate(const Law& law, const ElementTest& test);

/// Axial stress of a row.
inline double axial_stress(const ElementTest& test, std::size_t row) { return test.p[row] + 2 * test.q[row] / 3; }

}  // namespace rvelab::models
