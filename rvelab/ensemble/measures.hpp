// What the soil laboratory reads off one test: angles, moduli, cycles to liquefaction. Formulas and sources stand in
// protocols/README.md, "Measures". Compression positive; degrees, Pa.
#pragma once

#include <string>
#include <vector>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/records/record.hpp"

namespace rvelab::ensemble {

struct Measure {
  std::string name;  ///< ends in its unit
  std::string unit;  ///< "" for a pure number
  std::string meaning;
};

/// Every measure of a test.
const std::vector<Measure>& measures();

/// What a test gave, in the order of measures(); NaN where it does not give one.
std::vector<double> measured(const protocol::Protocol& protocol, const records::TestResult& test, int dimension);

/// Stresses at the largest deviator of the last stage; NaN where the last stage leads to no strength.
calibrate::PrincipalStresses strength_of(const protocol::Protocol& protocol, const records::TestResult& test,
                                         int dimension);

/// How a stress-controlled cyclic stage went.
struct Liquefaction {
  bool cyclic = false;      ///< the last stage turns at a stress
  bool liquefied = false;   ///< p fell below the limit
  double limit = 0;         ///< of p over p at the start: that of the stage's event p_over_first, else 0.05
  double cycles = 0;        ///< made until then, or in all; a turn counts half a cycle
  double least_p = 0;       ///< of p over p at the start
  double stress_ratio = 0;  ///< amplitude of the stress over p at the start
};
Liquefaction liquefaction_of(const protocol::Protocol& protocol, const records::TestResult& test, int dimension);

/// sin psi = -d eps_v/(2 d eps_1 - d eps_v), degrees (Vermeer and de Borst 1984), by the slope of eps_v in the axial
/// strain over the records within half of `window` of `at`; NaN with fewer than three.
double dilation_angle_deg(std::span<const records::Record> records, double at, double window = 0.01);

/// Secant at half of the largest deviator of a compression: modulus q/eps_1 (q = sigma_1 - sigma_3, from the start of
/// the stage) and Poisson's ratio: 2D 1 - eps_v/eps_1, 3D (1 - eps_v/eps_1)/2. `axis`: 0 to 2.
struct Secant {
  double modulus, poisson_ratio;
};
Secant secant_at_half(std::span<const records::Record> records, int axis, int dimension);

// Factors of a strip footing. N_q is calibrate::bearing_capacity_Nq.
using calibrate::bearing_capacity_Nc;
double bearing_capacity_Ngamma(double friction_angle_deg);  ///< 2 (N_q + 1) tan phi (Vesic 1973)
/// Radius of the log spiral at its end over that at its beginning, exp(pi/2 tan phi): the fan of 90 degrees between
/// the active and the passive wedge (Prandtl 1920).
double spiral_ratio(double friction_angle_deg);

}  // namespace rvelab::ensemble
