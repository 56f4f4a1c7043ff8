// Mohr-Coulomb: linear elastic, perfectly plastic, without cohesion (Smith and Griffiths, Programming the Finite
// Element Method, 4th ed. 2004, sec. 6.4).
//
//   failure    sigma_1 = N sigma_3,                    N = (1 + sin phi)/(1 - sin phi)
//   flow       d eps_3 = -N_psi d eps_1 in each pair of principal directions that fails, N_psi of the dilation angle
//   psi
//
// In triaxial compression two pairs fail at once (eps_1 = eps_a): d eps_v = (1 - N_psi) d eps_a beyond the peak. In
// extension the radial stress is the larger one.
#pragma once

#include "tools/models/element.hpp"

namespace rvelab::models {

class MohrCoulomb : public Law {
 public:
  /// Degrees, Pa.
  MohrCoulomb(double phi_deg, double psi_deg, double E, double nu);
  Rate rate(const Element& at, StrainRate d) const override;
  void settle(Element& at) const override;

 private:
  double N, N_psi, bulk, shear;
};

}  // namespace rvelab::models
