// Hardening Soil with small-strain stiffness, without cohesion.
//
// Schanz, Vermeer and Bonnier, The hardening soil model: formulation and verification, Beyond 2000 in Computational
// Geotechnics, Balkema 1999, 281-296; small strain: Benz, Small-strain stiffness of soils and its numerical
// consequences, thesis, Stuttgart 2007. sigma_1 and sigma_3 are the largest and smallest stress, q = sigma_1 - sigma_3.
//
//   stiffness     E50 = E50_ref (sigma_3/p_ref)^m, E_ur and G0 likewise; p_ref = 100 kPa
//   failure       q_f = sigma_3 2 sin(phi)/(1 - sin(phi)), q_a = q_f/R_f
//   shear         f = 2 q/(E_i (1 - q/q_a)) - 2 q/E_ur - gamma_p, E_i = 2 E50/(2 - R_f): the hyperbola of the drained
//                 triaxial test, eps_1 = q/(E_i (1 - q/q_a)), with E50 its secant at q_f/2
//   flow          d eps_v = -sin(psi_m) d gamma_p, Rowe's sin(psi_m) = (sin phi_m - sin phi_cv)/(1 - sin phi_m sin
//   phi_cv),
//                 not below zero for psi > 0, and psi itself for psi <= 0, as in Plaxis
//   cap           f = q~^2/alpha^2 + p^2 - p_p^2, associated, d eps_v = (beta/p_ref) (p_p/p_ref)^-m d p_p; q~ = q, in
//                 extension q (3 + sin phi)/(3 - sin phi). alpha and beta follow from K0nc and Eoed_ref: in first
//                 oedometric loading at sigma_1 = p_ref the stress ratio stays K0nc, and the modulus is Eoed_ref
//   small strain  shear modulus G0/(1 + 0.385 gamma/gamma_07)^2, not below G_ur; gamma = |eps_a - eps_r| since the last
//                 reversal; the plastic strain of shear is divided by (G/G_ur)^(1 + E_ur/(2 E50)), G the smallest yet
//                 (this factor from memory of Benz 2007; the cap has none here: isotropic compression has no gamma)
#pragma once

#include "tools/models/element.hpp"

namespace rvelab::models {

struct HardeningSoilParameters {
  double phi_deg, psi_deg;
  double E50, Eoed, Eur;  ///< Pa, at p_ref
  double m, nu_ur, K0nc, R_f;
  double G0, gamma_07;  ///< Pa at p_ref; shear strain at which G is 0.722 G0
};

class HardeningSoilSmall : public Law {
 public:
  explicit HardeningSoilSmall(const HardeningSoilParameters& parameters, bool with_cap = true);
  void start(Element& at) const override;
  Rate rate(const Element& at, StrainRate d) const override;
  void reverse(Element& at) const override;
  void settle(Element& at) const override;
  /// tau = G0 gamma/(1 + 0.385 gamma/gamma_07) until its tangent is G_ur, then on with G_ur, to p sin(phi) at most.
  double shear_stress(double gamma, double p) const override;
  /// K0nc and Eoed_ref can both be met by a cap.
  bool cap_exists() const { return exists; }
  /// As given, but E_ur not below E_i, and G0 not below G_ur.
  const HardeningSoilParameters& used() const { return given; }

 private:
  void fit_cap();
  double power(double sigma_3) const;
  double hyperbola(double q, double sigma_3) const;
  double cap(const Element& at) const;
  double tangent_shear(const Element& at) const;
  double mobilised_dilation(double q, double sum) const;

  HardeningSoilParameters given;
  bool with_cap, exists = true;
  double sin_phi, sin_cv, sin_psi, N, failure_ratio, E_i, G_ur, extension;
  double alpha2 = 1, beta = 1;
};

}  // namespace rvelab::models
