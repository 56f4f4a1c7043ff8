// Linear contact law with stiffnesses given as numbers (Liang et al. 2023, table 2): f_n = kn delta, f_t <- f_t - kt
// du_t, kn and kt in N/m, the harmonic mean of unlike grains.
#pragma once

#include "rvelab/contact/linear.hpp"

namespace rvelab {

struct GivenStiffness {
  double normal_stiffness = 0;      ///< N/m (linear_stiffness) or N/m^1.5 (hertz_stiffness), > 0
  double tangential_stiffness = 0;  ///< N/m, >= 0
  static constexpr StoredConstant<GivenStiffness> stored[] = {
      {"normal_stiffness", &GivenStiffness::normal_stiffness, "N/m or N/m^1.5"},
      {"tangential_stiffness_N_m", &GivenStiffness::tangential_stiffness, "N/m"}};
};

/// What laws of given stiffnesses share; `normal` is their own.
struct StiffnessLaw {
  template <class Each>
  static void parameters(Each each, const Parameter& normal) {
    each(normal, &GivenStiffness::normal_stiffness);
    each(Parameter{"tangential_stiffness_N_m", "tangential_stiffness", "N/m", number_from_zero, "kt",
                   "give the tangential stiffness of a contact, 0 for none"},
         &GivenStiffness::tangential_stiffness);
  }
  template <class Material>
  static ContactConstants mix(const Material& a, double /*ri*/, const Material& b, double /*rj*/, double /*section*/) {
    return {harmonic_mean(a.normal_stiffness, b.normal_stiffness),
            harmonic_mean(a.tangential_stiffness, b.tangential_stiffness)};
  }
};

struct LinearStiffnessLaw : StiffnessLaw {
  static constexpr const char* name = "linear_stiffness";
  using Force = LinearForce;

  template <class Each>
  static void parameters(Each each) {
    StiffnessLaw::parameters(each, {"normal_stiffness_N_m", "normal_stiffness", "N/m", positive_number, "kn",
                                    "give the normal stiffness of a contact"});
  }
};

}  // namespace rvelab
