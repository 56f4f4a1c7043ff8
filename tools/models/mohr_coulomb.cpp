#include "tools/models/mohr_coulomb.hpp"

#include <algorithm>
#include <cmath>

#include "tools/models/description.hpp"
#include "tools/models/plasticity.hpp"

namespace rvelab::models {
namespace {

double passive(double angle_deg) {
  const double s = std::sin(angle_deg * degree);
  return (1 + s) / (1 - s);
}

std::string missing_of_mohr_coulomb(const Tests& tests) {
  if (shear_tests(tests).empty()) return "a drained or undrained test that it may be fitted to";
  return "";
}

std::vector<Entry> parameters_of_mohr_coulomb(const Tests& tests, const Numbers&) {
  const double phi = largest_friction_angle_deg(tests);
  return {
      {"phi", "deg", "friction angle", phi, 5, 65, Origin::fitted, false},
      {"psi", "deg", "dilation angle", 0.3 * phi, -25, 45, Origin::fitted, false},
      {"E", "Pa", "Young's modulus", secant_modulus(tests).at_100_kPa, 1e5, 1e11, Origin::fitted, true},
      {"nu", "", "Poisson's ratio", 0.25, 0.01, 0.48, Origin::fitted, false},
  };
}

std::unique_ptr<Law> law_of_mohr_coulomb(const std::vector<double>& v) {
  return std::make_unique<MohrCoulomb>(v[0], v[1], v[2], v[3]);
}

}  // namespace

MohrCoulomb::MohrCoulomb(double phi_deg, double psi_deg, double E, double nu)
    : N(passive(phi_deg)), N_psi(passive(psi_deg)), bulk(E / (3 * (1 - 2 * nu))), shear(E / (2 * (1 + nu))) {}

Rate MohrCoulomb::rate(const Element& at, StrainRate d) const {
  Mechanism compression, extension;
  compression.active = at.sigma_a >= N * at.sigma_r * (1 - 1e-9);
  compression.normal = {1, -N};
  compression.flow = {1, -0.5 * N_psi};
  extension.active = at.sigma_r >= N * at.sigma_a * (1 - 1e-9);
  extension.normal = {-N, 1};
  extension.flow = {-N_psi, 0.5};
  const auto rate = plastic_rate({bulk, shear}, {compression, extension}, d);
  return {rate.stress[0], rate.stress[1], {}};
}

void MohrCoulomb::settle(Element& at) const { at.sigma_a = std::clamp(at.sigma_a, at.sigma_r / N, at.sigma_r * N); }

const Description& mohr_coulomb() {
  static const Description description{
      "mohr_coulomb", "Mohr-Coulomb", missing_of_mohr_coulomb, parameters_of_mohr_coulomb, law_of_mohr_coulomb, nullptr,
      nullptr,        false};
  return description;
}

}  // namespace rvelab::models
