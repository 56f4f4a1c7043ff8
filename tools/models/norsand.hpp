// NorSand in triaxial conditions.
//
// Jefferies, Nor-Sand: a simple critical state model for sand, Geotechnique 43 (1993) 91-103; Jefferies and Been, Soil
// Liquefaction, 2nd ed. 2016, ch. 3 and app. C, D (as in the authors' program NorTxl2). p_i is the image pressure,
// where the yield surface crosses critical stress ratio; eta = |q|/p.
//
//   critical state  e_c = Gamma - lambda ln(p/1 kPa),  psi = e - e_c at p, psi_i at p_i
//   yield           eta = M_i (1 + ln(p_i/p)),  M_i = M (1 - N chi_i |psi_i|/M_tc),  chi_i = chi/(1 - lambda chi/M_tc)
//                   M = M_tc in compression, 3 M_tc/(3 + M_tc) in extension
//   flow            d eps_v = (M_i - eta) d eps_q; largest dilation chi_i psi_i
//   hardening       d p_i/p_i = H (M_i/M_itc) (p/p_i)^2 (exp(-chi_i psi_i/M_itc) - p_i/p) d eps_q,
//                   M_itc = M_tc - N chi_i |psi_i|; at constant volume also, for the softening of the inner cap,
//                   - (eta/eta_L) D (K/p) d eps_q/(1 + chi_i lambda/M_tc), eta_L = M_i (1 - chi_i psi_i/M_itc)
//   elasticity      G = I_r p_ref (p/p_ref)^n, p_ref = 100 kPa, Poisson's ratio nu (n = 1: G = I_r p)
//
// Not calculated: the inner cap itself in unloading (which is elastic until the stress ratio yields on the other side).
#pragma once

#include "tools/models/element.hpp"

namespace rvelab::models {

struct NorSandParameters {
  double Gamma, lambda;  ///< lambda of the natural logarithm
  double M_tc, N, chi, H, I_r, nu;
  double elastic_exponent = 1;  ///< n
};

class NorSand : public Law {
 public:
  explicit NorSand(const NorSandParameters& parameters);
  void start(Element& at) const override;
  Rate rate(const Element& at, StrainRate d) const override;
  void settle(Element& at) const override;
  /// Of an element.
  double state_parameter(const Element& at) const;
  double image_pressure(const Element& at) const { return at.memory[0]; }

 private:
  struct Image {
    double psi, M, M_i, M_itc;
  };
  Image image(const Element& at, bool compression) const;

  NorSandParameters given;
  double chi_i;
};

}  // namespace rvelab::models
