// Hypoplasticity of von Wolffersdorff, A hypoplastic relation for granular materials with a predefined limit state
// surface, Mech. Cohes.-Frict. Mater. 1 (1996) 251-271. T^ = T/tr T, T^* its deviator; here compression is positive.
//
//   dT = f_s/tr(T^ T^) (F^2 D + a^2 T^ tr(T^ D) - f_d a F (T^ + T^*) |D|),   f_s = f_b f_e
//   a = sqrt(3) (3 - sin phi_c)/(2 sqrt(2) sin phi_c)
//   F = sqrt(tan^2 psi/8 + (2 - tan^2 psi)/(2 + sqrt(2) tan psi cos 3 theta)) - tan psi/(2 sqrt(2)),
//       tan psi = sqrt(3) |T^*|, cos 3 theta = -sqrt(6) tr(T^*^3)/(tr T^*^2)^1.5: F = 1 in triaxial compression
//   e_i/e_i0 = e_c/e_c0 = e_d/e_d0 = exp(-(3 p/h_s)^n)                                        (Bauer 1996)
//   f_d = ((e - e_d)/(e_c - e_d))^alpha,  f_e = (e_c/e)^beta
//   f_b = h_s/n (e_i0/e_c0)^beta (1 + e_i)/e_i (3 p/h_s)^(1 - n)/(3 + a^2 - a sqrt(3) ((e_i0 - e_d0)/(e_c0 -
//   e_d0))^alpha)
//
// Without intergranular strain: small strains and cycles are too soft, and are not calculated.
#pragma once

#include "tools/models/element.hpp"

namespace rvelab::models {

struct HypoplasticityParameters {
  double phi_c_deg;
  double h_s;  ///< Pa
  double n, e_d0, e_c0, e_i0, alpha, beta;
};

class Hypoplasticity : public Law {
 public:
  explicit Hypoplasticity(const HypoplasticityParameters& parameters);
  Rate rate(const Element& at, StrainRate d) const override;
  /// exp(-(3 p/h_s)^n)
  double compression(double p) const;

 private:
  HypoplasticityParameters given;
  double a, barotropy;  ///< f_b without what depends on the state
};

}  // namespace rvelab::models
